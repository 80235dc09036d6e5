"""Files of a megabyte that are made to take all memory, or all time: read or refused, in little."""

import io
import json
import sqlite3
import struct
import zlib
from collections.abc import Callable, Iterator
from contextlib import closing
from pathlib import Path
from typing import TypeVar

import pytest
from PIL import Image

from affcli.bounded import LARGEST_FILE, LARGEST_VALUE
from tests.cli.forked import Forked
from tests.cli.program import done, refused
from tests.fuzz.running import check_ending

SLOWER = 3.0
"""A machine that does other things too may take so much longer than the two seconds of the bar."""
MEMORY = 200_000_000
"""Bytes that a command may take beyond what the program has when it is idle."""

SETTINGS = {
    "dots in a key": "arm" + ".b" * 90_000 + " = 1",
    "dots in a section": "[arm" + ". b" * 300_000 + "]",
    "lists": "arm = " + "[" * 999_000,
    "tables": "arm = " + "{x = " * 190_000,
    "sections": "".join(f"[t{n}]\n" for n in range(80_000)),
    "sections in sections": "".join(f"[arm.b{n}]\n" for n in range(60_000)),
    "lists of sections": "[[arm]]\n" * 120_000,
    "keys": "[arm]\n" + "".join(f"k{n} = 1\n" for n in range(70_000)),
    "keys of keys": "".join(f"arm.b.c.d{n} = 1\n" for n in range(50_000)),
    "a long key": "[arm]\n" + "k" * 900_000 + " = 1",
    "a long section": "[" + "s" * 900_000 + "]",
    "digits": "arm.upper_arm = " + "1" * 900_000,
    "hexadecimal digits": "arm.upper_arm = 0x" + "f" * 900_000,
    "decimals": "arm.upper_arm = 1." + "1" * 900_000,
    "numbers": "arm.upper_arm = [" + "1," * 450_000 + "]",
    "empty lists": "arm.upper_arm = [" + "[]," * 300_000 + "]",
    "a long text": 'arm.upper_arm = "' + "x" * 900_000 + '"',
    "quotes that are none": 'arm.upper_arm = "' + '\\"' * 490_000,
    "quotes without end": 'arm.upper_arm = """' + '"" ' * 330_000,
    "a remark": "#" * 900_000,
    "lines": "\n" * 900_000,
}
COLORS = {
    "colors": "".join(f"[c{n}]\nrgb = [{n % 256}, 200, 0]\n" for n in range(25_000)),
    "a long name": "[" + "c" * 900_000 + "]\nrgb = [30, 110, 200]\n",
}
SIZES = (
    '{"width_px": 640, "height_px": 480, "sensor_width_mm": 5, "focal_length_mm": 5, '
    '"distortion_per_mm2": 0, "translation_in": [0, 0, 9], "rotation": ['
)
CALIBRATIONS = {
    "lists": "[" * 999_000,
    "objects": '{"a":' * 190_000,
    "digits": '{"width_px": ' + "1" * 900_000 + "}",
    "numbers": SIZES + "0," * 450_000 + "0]}",
    "empty lists": SIZES + "[]," * 300_000 + "[]]}",
    "keys": json.dumps({str(n): 0 for n in range(70_000)}),
    "quotes that are none": '{"' + '\\"' * 490_000,
    "notes": '{"capture": {"camera": "' + "x" * 900_000 + '"}}',
}


def chunk(kind: bytes, data: bytes) -> bytes:
    """Return a chunk of a PNG file."""
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def png(width: int, height: int, bits: int, kind: int, *, interlaced: bool = False) -> bytes:
    """Return a black PNG picture: so many zeros take next to no room."""
    samples = {0: 1, 2: 3, 3: 1, 4: 2, 6: 4}[kind]
    row, packer = bytes(1 + width * samples * bits // 8), zlib.compressobj(9)
    packed = b"".join(packer.compress(row) for _ in range(height))
    # A picture that is interlaced has more rows, which are shorter.
    packed += packer.compress(bytes(2 * height)) + packer.flush()
    header = struct.pack(">IIBBBBB", width, height, bits, kind, 0, 0, interlaced)
    colors = chunk(b"PLTE", bytes(768)) if kind == 3 else b""
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + colors + chunk(b"IDAT", packed)


def notes(count: int) -> bytes:
    """Return a PNG picture with many notes, each a thousand times as long when it is unpacked."""
    note = chunk(b"zTXt", b"Comment\0\0" + zlib.compress(bytes(1_000_000), 9))
    return png(64, 64, 8, 2)[:33] + note * count


def jpeg(width: int, height: int, *, progressive: bool) -> bytes:
    """Return a grey JPEG picture."""
    file = io.BytesIO()
    Image.new("RGB", (width, height)).save(file, "JPEG", progressive=progressive, quality=10)
    return file.getvalue()


def scans() -> bytes:
    """Return a JPEG picture that goes over its pixels again and again."""
    whole = jpeg(3000, 2000, progressive=True)
    last = whole.rindex(b"\xff\xda")
    scan = whole[last:-2]
    return whole[:-2] + scan * ((990_000 - len(whole)) // len(scan)) + whole[-2:]


PICTURES: dict[str, Callable[[], bytes]] = {
    "as large as a name can say": lambda: png(2**31 - 1, 1, 8, 0)[:33] + b"x" * 1000,
    "65,000 by 65,000": lambda: (
        b"\xff\xd8\xff\xc0\x00\x11\x08\xfd\xe8\xfd\xe8\x03\x01\x11\x00"
        b"\x02\x11\x01\x03\x11\x01" + bytes(1000)
    ),
    "12 megapixels": lambda: png(4000, 3000, 8, 2),
    "12 megapixels with 16 bits": lambda: png(4000, 3000, 16, 6),
    "12 megapixels interlaced": lambda: png(4000, 3000, 8, 6, interlaced=True),
    "12 megapixels of a palette": lambda: png(4000, 3000, 8, 3),
    "12 megapixels of 16 greys": lambda: png(4000, 3000, 16, 0),
    "24 megapixels": lambda: png(6000, 4000, 8, 2),
    "a strip": lambda: png(32, 375_000, 8, 2),
    "notes": lambda: notes(900),
    "12 megapixels in one go": lambda: jpeg(4000, 3000, progressive=False),
    "12 megapixels bit by bit": lambda: jpeg(4000, 3000, progressive=True),
    "scans": scans,
}
NUMBERS = json.dumps({str(n): n for n in range(6000)})
MAP = """
[log]
source = "x"
[columns]
tool = 1
behavior = 2
start_x = 3
start_y = 4
end_x = 5
end_y = 6
"""
LOGS = {
    "trials": "a b 0 0 9 9\n" * 80_000,
    "tools": "".join(f"t{n} b 0 0 9 9\n" for n in range(29_000)),
    "behaviors": "".join(f"t b{n} 0 0 9 9\n" for n in range(29_000)),
    "objects": "".join(f"a b 0 0 {n % 7} 9\n" for n in range(29_000)),
    "a long line": "a" * 999_000,
    "a line of columns": "a " * 490_000,
    "lines": "\n" * 999_000,
    "bad lines": "x\n" * 490_000,
    "bad numbers": "a b 0 0 9 x\n" * 80_000,
    "digits": "a b 0 0 9 " + "9" * 900_000,
    "quotes": 'a,"' + '""' * 490_000,
}
MAPS = {
    "lists": MAP + "x = " + "[" * 999_000,
    "names": MAP + "[names.tool]\n" + "".join(f"k{n} = 'a{n}'\n" for n in range(50_000)),
    "parameters": MAP + "[parameters]\n" + "".join(f"k{n} = 1\n" for n in range(70_000)),
    "a long source": MAP.replace('"x"', f'"{"x" * 900_000}"'),
}
"""Logs and the maps by which they are read."""
CORNERS = [["handle", [[n, n * n] for n in range(5000)]]]
MANY = {
    "many settings": ("learning_run", "settings", NUMBERS),
    "deep settings": ("learning_run", "settings", '{"a": ' + "[" * 40_000 + "]" * 40_000 + "}"),
    "many versions": ("learning_run", "versions", NUMBERS),
    "a long name": ("learning_run", "tool", "t" * 90_000),
    "many corners": (
        *("tool", "definition"),
        json.dumps({"name": "stick", "color": [1, 2, 3], "parts": CORNERS}),
    ),
    "many parameters": ("affordance", "exploratory_params", NUMBERS),
    "a long behavior": ("affordance", "exploratory_behavior", "b" * 90_000),
    "many behaviors": ("learning_run", "repertoire", ""),
}
"""A value of 100 kB, by the table and the column; the last is what is there, again and again."""
READERS = (
    ("report",),
    ("replay", "--run", "1"),
    ("table", "list", "--all-runs"),
    ("figure", "affordances", "--run", "1", "--out", "new.svg", "--force"),
    ("db", "check"),
)


T = TypeVar("T")
EACH = 3
"""Of each kind of file one in so many, the first among them, is tried but in `make torture`."""


def some(files: dict[str, T], torture: bool) -> list[tuple[str, T]]:
    """Return files with their names: all of them, or a few."""
    return list(files.items())[:: 1 if torture else EACH]


@pytest.fixture(scope="module")
def program() -> Iterator[Forked]:
    held = Forked()
    yield held
    held.close()


@pytest.fixture(scope="module")
def known(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with a picture, its calibration, and a small database."""
    folder = tmp_path_factory.mktemp("known")
    done("camera", "view", "--frame", "--out", "view.png", cwd=folder)
    done("camera", "calibrate", "--out", "camera.json", cwd=folder)
    done("learn", "--tool", "stick", "--behaviors", "60", "--db", "small.db", cwd=folder)
    return folder


def suffered(program: Forked, folder: Path, *args: str) -> float:
    """Run a command in little memory; return the processor time that it took (s)."""
    ended = program.run(args, folder, bounds={"memory": MEMORY})
    check_ending(" ".join(args[:2]), ended)
    assert not ended.stopped, args
    assert "memory ran out" not in ended.err, ended
    return program.took


@pytest.mark.fault(42)
@pytest.mark.torture
def test_every_small_text_is_read_or_refused_in_little_memory(
    program: Forked, known: Path, torture: bool, tell: Callable[[str], None]
) -> None:
    took = {}
    locate = ("camera", "locate", "view.png", "--calibration")
    for name, text in some(SETTINGS, torture):
        (known / "odd.toml").write_text(text)
        took[f"settings: {name}"] = suffered(program, known, "settings", "--config", "odd.toml")
    for name, text in some(COLORS, torture):
        (known / "odd.toml").write_text(text)
        colored = (*locate, "camera.json", "--colors", "odd.toml")
        took[f"colors: {name}"] = suffered(program, known, *colored)
    for name, text in some(CALIBRATIONS, torture):
        (known / "odd.json").write_text(text)
        took[f"calibration: {name}"] = suffered(program, known, *locate, "odd.json")
    tell(slowest(took))


@pytest.mark.fault(42)
@pytest.mark.torture
def test_every_small_log_is_read_or_refused_in_little_memory(
    program: Forked, known: Path, torture: bool, tell: Callable[[str], None]
) -> None:
    took = {}
    called = ("import", "odd.txt", "--map", "odd.toml", "--db", "odd.db")
    for kind, files in (("log", LOGS), ("map", MAPS)):
        for name, text in some(files, torture):
            (known / "odd.txt").write_text(text if kind == "log" else "a b 0 0 9 9\n")
            (known / "odd.toml").write_text(text if kind == "map" else MAP)
            (known / "odd.db").unlink(missing_ok=True)
            took[f"{kind}: {name}"] = suffered(program, known, *called)
            assert took[f"{kind}: {name}"] < 2.0 * SLOWER
    (known / "odd.db").unlink(missing_ok=True)
    tell(slowest(took))


@pytest.mark.fault(42)
@pytest.mark.torture
def test_every_small_picture_is_read_or_refused_in_little_memory(
    program: Forked, known: Path, torture: bool, tell: Callable[[str], None]
) -> None:
    took = {}
    for name, made in some(PICTURES, torture):
        picture = made()
        assert len(picture) <= LARGEST_FILE, name
        (known / "odd.png").write_bytes(picture)
        calls = (("calibrate", "odd.png"), ("locate", "odd.png", "--calibration", "camera.json"))
        for call in calls if torture else calls[:1]:
            took[f"{call[0]}: {name}"] = suffered(program, known, "camera", *call)
    tell(slowest(took))


@pytest.mark.fault(42)
@pytest.mark.torture
def test_every_small_database_is_read_or_refused_in_little_memory(
    program: Forked, known: Path, torture: bool, tell: Callable[[str], None]
) -> None:
    took = {}
    database = known / "odd.db"
    for name, (table, column, value) in some(MANY, torture):
        database.write_bytes((known / "small.db").read_bytes())
        with closing(sqlite3.connect(database)) as driver, driver:
            (kept,) = driver.execute(f"SELECT {column} FROM {table}").fetchone()
            much = value or f"[{', '.join([kept[1:-1]] * (90_000 // len(kept)))}]"
            first = f"SELECT min(rowid) FROM {table}"
            driver.execute(f"UPDATE {table} SET {column} = ? WHERE rowid = ({first})", [much])
        for args in READERS if torture else READERS[:2]:
            took[f"{args[0]}: {name}"] = suffered(program, known, *args, "--db", "odd.db")
    tell(slowest(took))


@pytest.mark.fault(42)
def test_a_value_that_is_too_large_is_not_read(known: Path) -> None:
    database = known / "odd.db"
    database.write_bytes((known / "small.db").read_bytes())
    with closing(sqlite3.connect(database)) as driver, driver:
        value = json.dumps({"a": "x" * LARGEST_VALUE})
        driver.execute("UPDATE learning_run SET settings = ?", [value])
    for args in READERS[:-1]:
        line = refused(3, *args, "--db", "odd.db", cwd=known)
        assert f"odd.db: holds a value of more than {LARGEST_VALUE} bytes" in line


def slowest(took: dict[str, float]) -> str:
    """Say how many files there were, and what took the longest."""
    most = sorted(took, key=took.__getitem__)[-3:]
    return f"{len(took)} files; of processor time took " + ", ".join(
        f"{name} {took[name]:.1f} s" for name in reversed(most)
    )
