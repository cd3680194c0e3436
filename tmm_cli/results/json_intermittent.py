"""The part of result.json that comes from intermittent motion."""

from __future__ import annotations

from tmm_cli.results.shapes import FLAG, INTEGER, NUMBER, TEXT, Field, list_of, map_of, optional, record

PART = record(
    "a part of the cycle",
    Field("driven", FLAG, "whether the wheel is driven, else it stands", "ride.driven"),
    Field("setting", INTEGER, "which of the settings, from 0"),
    Field("start", NUMBER, "driver's place at its beginning", "ride.start"),
    Field("end", NUMBER, "driver's place at its end", "ride.end"),
    Field("time", NUMBER, "that it takes, s; null where the driver's speed changes"),
    Field("from", NUMBER, "angle of the wheel at its beginning, rad", lambda part: part.angles[0]),
    Field("step", NUMBER, "of the wheel, rad"),
    Field("omega", NUMBER, "largest angular speed, rad/s"),
    Field("epsilon", NUMBER, "largest angular acceleration, rad/s^2"),
)
WHEEL = record(
    "a wheel that a link takes along",
    Field("name", TEXT, "of the wheel", "task.name"),
    Field("link", TEXT, "that moves it", "task.link"),
    Field("when", TEXT, "as the file says", "task.when"),
    Field("settings", list_of(map_of(TEXT)), "values of parameters as the file writes them",
          lambda wheel: [setting.values for setting in wheel.task.settings]),
    Field("turn", NUMBER, "in a cycle, rad"),
    Field("way", NUMBER, "of the driver in a cycle, there and back"),
    Field("standing", NUMBER, "share of that way on which it stands"),
    Field("cycles", optional(INTEGER), "in which it makes whole turns; null where there are none"),
    Field("omega", NUMBER, "largest angular speed, rad/s"),
    Field("epsilon", NUMBER, "largest angular acceleration while it is driven, rad/s^2"),
    Field("shock", NUMBER, "largest jump of angular speed, rad/s; zero where it is taken up and let go without shock"),
    Field("parts", list_of(PART), "one after another"),
)  # fmt: skip
