"""``affcli list``: the parts that a run can be made of, by name."""

from typing import Annotated

import typer

from affcli import registry
from affcli.cli.options import AsJson
from affcli.cli.terminal import say, show_either
from affcli.core.names import one_of
from affcli.core.part import Part
from affcli.errors import one_line
from affcli.report.parts import parts_json, parts_tables


def list_parts(
    kind: Annotated[
        str | None, typer.Argument(help=f"{', '.join(registry.KINDS)}.", metavar="KIND")
    ] = None,
    *,
    as_json: AsJson = False,
) -> None:
    """List the parts that a run can be made of: what each is, its parameters, its source.

    Those of other packages too, each with its package; one that cannot be used is named.

    An option takes a part as name or name:key=value,key=value, as in --planner
    nested-query:share=0.05.
    """
    wanted = registry.KINDS if kind is None else [one_of("kind of part", kind, registry.KINDS)]
    found = {one: dict(registry.parts(one)) for one in registry.KINDS if one in wanted}
    for own, parts in found.items():
        for offer, part in registry.of_packages(own):
            if isinstance(part, Part):
                parts[offer.name] = part
            else:
                say(f"left out: {one_line(part, 500)}")
    show_either(
        as_json=as_json,
        results=lambda: parts_json(found),
        tables=lambda: list(parts_tables(found)),
    )
