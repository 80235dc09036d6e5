"""What every part of the registry must keep to, whatever its kind."""

from affcli.core.identity import Component
from affcli.core.part import Part


class PartContract:
    """A part says what it is, and is made with its parameters wherever they may lie.

    A subclass gives the fixture `part`.
    """

    def test_it_says_what_it_is_and_where_it_comes_from(self, part: Part) -> None:
        assert Component.parse(part.name) == Component(part.name)
        for text in (part.summary, part.source):
            assert text.strip() == text != ""
            assert text.isprintable()
        assert part.version >= 1

    def test_a_parameter_has_a_meaning_and_limits_that_hold_its_default(self, part: Part) -> None:
        for name, one in part.params.items():
            assert one.meaning, name
            assert one.choices or one.low < one.high, name
            assert not one.refusal(one.canonical(one.default)), name

    def test_a_component_is_the_same_after_its_text(self, part: Part) -> None:
        for name, one in part.params.items():
            for value in one.choices or (one.low, one.high):
                made = part.component({name: value})
                assert Component.parse(str(made)) == made
