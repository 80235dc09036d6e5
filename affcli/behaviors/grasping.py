"""The binding behavior: the hand takes the tool by its handle (§5.1)."""

from affcli.core.behavior import GRASP, BehaviorCall
from affcli.core.part import Part
from affcli.core.setting import Setting
from affcli.core.workspace import ToolGeometry
from affcli.errors import BadInputError


def grasp(
    geometry: ToolGeometry, *, grasp_point: float | None = None, angle: float = 0.0
) -> BehaviorCall:
    """Return the call that grasps the handle.

    Args:
        geometry: where the paper's own grasp point is, for a call that names none.
        grasp_point: along the handle from its lower end (in).
        angle: by how much the tool is turned in the hand (degrees, counter-clockwise).

    Raises:
        BadInputError: the handle ends before the grasp point.
    """
    point = geometry.handle_below_grasp if grasp_point is None else grasp_point
    end = geometry.handle_below_grasp + geometry.handle_length
    if point > end:
        raise BadInputError(
            f"grasp: grasp_point = {point:g} lies beyond the end of the handle, at {end:g} in; "
            "give a lower one"
        )
    return BehaviorCall.of(GRASP, {"grasp_point": point, **({"angle": angle} if angle else {})})


PARTS = (
    Part(
        kind="bindings",
        name="grasp",
        summary="the hand takes the handle at a point, the tool straight ahead or turned",
        source="Stoytchev 2008, §5.1",
        build=grasp,
        params={
            "grasp_point": Setting(
                *(1.0, "in"),
                "Along the handle from its lower end; as tools.handle_below_grasp if not given.",
                *(0.0, 100.0),
            ),
            "angle": Setting(0.0, "degrees", "The tool turned in the hand.", -180.0, 180.0),
        },
    ),
)
