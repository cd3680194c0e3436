"""The shape of the block `balancing`: counterweights that are sought, and a shaft with masses in planes."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import BeforeValidator, Field

from tmm_cli.problem.schema_parts import Name, Place, Strict, Value, checked_value


class Counterweight(Strict):
    """A counterweight on a link; its size and its angle are found."""

    about: Place | None = Field(default=None, description="its hinge on the frame, or its first point, if left out")
    radius: Value | None = Field(default=None, description="of its centre of mass: then its mass is told too")


class RotorMass(Strict):
    """A mass that turns with the shaft."""

    mass: Value
    radius: Value
    angle: Value = 0
    at: Value = Field(default=0, description="place of its plane along the shaft")


class RotorPlane(Strict):
    """A plane in which a mass is sought."""

    at: Value = Field(description="place along the shaft")
    radius: Value | None = Field(default=None, description="of the mass that is sought there")


def _plane(found: Any) -> Any:
    return found if isinstance(found, dict) else {"at": checked_value(found)}


class Rotor(Strict):
    """A shaft with masses, balanced by others in one plane (statically) or in two (dynamically)."""

    masses: list[RotorMass] = Field(min_length=1, max_length=100)
    planes: list[Annotated[RotorPlane, BeforeValidator(_plane, json_schema_input_type=RotorPlane | Value)]] = Field(
        min_length=1, max_length=2
    )


class Balancing(Strict):
    """What shakes the frame at constant speed of the driver, and what balances it."""

    counterweights: dict[Name, Counterweight] = Field(default_factory=dict, max_length=20, description="by their links")
    share: Value | None = Field(
        default=None,
        description="how much the force along the guide of the output counts, the rest of one across it; of a "
        "crank-slider the share of the reciprocating masses that is balanced. Without it both count alike",
    )
    rotor: Rotor | None = None
