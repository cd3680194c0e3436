"""Words of `tmm synthesis` that all tasks share; each task has its own file beside this one."""

WORDS: dict[str, str] = {
    "synthesis.asked": "Asked: {task}",
    "synthesis.found": "Found",
    "synthesis.measured": "What was asked and foretold, measured on the mechanism",
    "synthesis.quantity": "quantity",
    "synthesis.name": "parameter",
    "synthesis.wanted": "wanted",
    "synthesis.on_mechanism": "measured",
    "synthesis.difference": "relative difference",
    "synthesis.by": "by",
    "synthesis.by_task": "asked",
    "synthesis.by_formula": "foretold",
    "synthesis.source": "Source: {source}",
    "synthesis.none": "none",
    "synthesis.not_met": "{quantity}: wanted {wanted}, measured {found}",
    "synthesis.no_block": "this file has no synthesis",
    "synthesis.no_linkage": "the file has no linkage: nothing was measured",
    "synthesis.extremes": "Extreme positions of the output",
    "synthesis.explain": "Parameters found by synthesis",
    "synthesis.task": "task",
}
