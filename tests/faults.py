"""What can happen to a laboratory and its files, and what must follow: tests name each entry.

A test that is about one of them says so with ``@pytest.mark.fault(number)``; `tests/test_faults.py`
sees to it that each has one. Exit codes: 2 usage, 3 database, 4 bad input. Always: one line on
stderr that says what is wrong, where, and what to do; never a traceback; nothing that was saved is
lost. The numbers left out stand for what affcli does not have yet: databases on a server.
"""

FAULTS = {
    1: "Learning is killed (SIGKILL), again and again: every behavior that was said or seen to be "
    "saved is there, and SQLite finds the file sound.",
    2: "What was killed or interrupted is gone on with: at the end every table equals that of a "
    "run that nobody disturbed, but for when it happened.",
    3: "Ctrl-C or SIGTERM: it ends within two seconds with 130 or 143, keeps what was saved, and "
    "says how to go on.",
    4: "The disk is full, or a quota is reached: 3, the file stays good, and with room again the "
    "same command goes on.",
    5: "Another process holds the lock for longer than one waits: 3, and it is named.",
    6: "Several learn on one file at once: all succeed, no lock is an error, nothing is there "
    "twice or missing.",
    7: "Somebody reads the file all the while, or for a minute in one go: the writer goes on or "
    "waits, and loses nothing.",
    8: "Eight first runs, or eight upgrades, at once on one file: it is migrated once, and all of "
    "them end with 0.",
    9: "A kill in the middle of a migration: the schema is the old one or the new one, with "
    "all that was in it.",
    10: "A migration fails: the copy that was made before is named, and can be used; the database "
    "is as it was.",
    11: "The schema is newer than the program: 3, both revisions are named, nothing is written.",
    12: "A schema is to be taken back to an older one, which lacks room for what is there: 3, "
    "nothing is written, and the copy from before the upgrade is named.",
    13: "No database, a truncated one, one with a damaged page: 3, and the file is left untouched.",
    14: "The file is empty, or another program's: writing makes a database of the first; the other "
    "is refused.",
    15: "The file is missing: a command that reads says so, and makes none.",
    16: "The file or its folder is read-only: reading works, writing is 3.",
    17: "A write-ahead log with a SQLite that cannot be trusted with it, or a file system of a "
    "network: `affcli doctor` points it out and says what to do.",
    18: "A copy is made during a run: it opens, and its counts agree with one another.",
    19: "Something is said to be saved: the disk has confirmed it before.",
    20: "A tool is named as a path, absolute or through a link, which is no TOML file, or a file "
    "gives it such a name: refused; and no output goes anywhere but where it was asked for.",
    21: "Names with markup, escape sequences, NUL, halves of characters, or of 10 kB: refused, or "
    "shown escaped.",
    22: "SQL where a name is wanted, anywhere: it is a name and nothing else.",
    23: "NaN, infinity, negative masses, frictions and sizes: 4, the field is named, and they "
    "never reach the physics engine, which would end the process.",
    24: "A tool of 100,000 corners, or a file of 10 MB: 4, within a second.",
    25: "A tool's outline that crosses itself or has no area: 4, and the place is named; one that "
    "is drawn clockwise is taken as if it were not.",
    26: "A tool's outline that bends inwards: it is cut into convex parts, whose areas sum to its "
    "own.",
    27: "TOML that is nested deep, or a number of thousands of digits: 4.",
    28: "A part of another package fails to load, raises, answers nonsense, loops or ends its "
    "process: it is named with its package and the rest works; a trial that it ended is recorded "
    "as invalid, with what it did.",
    29: "The simulation diverges: the trial is invalid, and never counts as a success.",
    30: "`affcli sql` with anything but one SELECT, or one that is endless or huge: denied, or "
    "stopped within two seconds.",
    31: "HTML in a name: it is text in the page, which loads nothing from outside.",
    32: "A cell of a CSV that a spreadsheet would take for a formula: it is quoted as text, and "
    "numbers are left alone.",
    33: "NaN or infinity where JSON is asked for: the JSON is valid.",
    35: "A reader who leaves (`| head`), no terminal, 40 columns, NO_COLOR: a clean end, and text "
    "that can be read.",
    36: "A seed of 2^63, or a negative one: 4.",
    37: "A command is killed between two commits, or within one (`tests/states/kinds.py` lists "
    "what that leaves): every command that reads does so or says in one line why not; `affcli db "
    "check` names what is unfinished; the same command goes on.",
    38: "A record holds a value that affcli did not write: a command that needs it names it, what "
    "is asked of other records is answered, and `affcli db check` finds it.",
    39: "Something is to be resumed where nothing was interrupted: refused, and no file is made.",
    40: "Another process holds the lock for a moment, again and again: every command waits from "
    "the opening of the file on, says after five seconds for whom, and ends as ever.",
    41: "Several use the table of one run at once: they take turns trial by trial, and every "
    "trial can be replayed.",
    42: "A file or a stored value that grows when it is read: refused by its size or its depth "
    "before it is parsed.",
    43: "The clock goes back, or stands in another century: results are the same, and the order in "
    "which things were begun decides which is the latest.",
    44: "Killed commands leave files half written: the next command that writes the same one "
    "removes those that are an hour old.",
    45: "A signal in the first moment, before affcli listens to any: it ends silently, 130 or 143.",
    46: "Memory runs out, also for a library, a thread or a child: 4, and a line that says so; "
    "never a hang.",
}
"""What happens, and what must follow, by number."""
