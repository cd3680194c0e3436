"""Words that all tables share."""

WORDS: dict[str, str] = {
    "word.what": "what",
    "word.value": "value",
    "word.unit": "unit",
    "word.link": "link",
    "word.links": "links",
    "word.pair": "pair",
    "word.point": "point",
    "word.group": "group",
    "word.position": "position",
    "word.state": "state",
}
