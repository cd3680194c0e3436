"""A student's sheet as a page that stands alone, small, without scripts, as good on paper."""

from __future__ import annotations

from collections.abc import Iterable
from html import escape

from tmm_cli.grading.exports.student_sheet import Sheet
from tmm_cli.language import _

STYLE = """
body{font:16px/1.45 system-ui,sans-serif;color:#1a1a1a;max-width:60rem;margin:2rem auto;padding:0 1rem;
overflow-wrap:anywhere}
h1{font-size:1.35rem;margin:0}h2{font-size:1.05rem;margin:1.6rem 0 .3rem}
.who{margin:.2rem 0 1.2rem}.who b{font-size:1.1rem}
table{border-collapse:collapse;width:100%;font-variant-numeric:tabular-nums}
th,td{text-align:left;padding:.3rem .7rem .3rem 0;border-bottom:1px solid #ddd;vertical-align:top}
th{border-bottom:2px solid #1a1a1a;font-weight:600}td:first-child,th:first-child{padding-left:.6rem}
td{white-space:nowrap}td:nth-child(2),td:nth-last-child(3),td:last-child{white-space:normal}
td:first-child{border-left:4px solid #b3261e}.right td:first-child{border-left-color:#1d7a3a}
.follows td:first-child{border-left-color:#c77700}.missing td:first-child{border-left-color:#bbb}
.missing td{color:#767676}ul{padding-left:1.2rem;margin:.3rem 0}li{margin:.2rem 0}
.about,.note{color:#555;font-size:.87rem}.note{margin:.5rem 0}.note:first-of-type{margin-top:1rem}
@media print{body{margin:0;max-width:none;font-size:10.5pt}tr,li{break-inside:avoid}td:first-child{
print-color-adjust:exact;-webkit-print-color-adjust:exact}@page{margin:18mm}}
"""
BETWEEN = "\x1f"  # cells
HEAD = (
    '<!doctype html>\n<html lang="en"><head><meta charset="utf-8">'
    '<meta name="viewport" content="width=device-width,initial-scale=1">'
    "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none';style-src 'unsafe-inline'\">"
)


def text(sheet: Sheet) -> str:
    """A sheet as a page; names are kept apart in their own direction of writing."""
    problems = _list(f"<li>{escape(problem)}</li>" for problem in sheet.problems)
    header = "".join(f"<th>{escape(header)}</th>" for header in sheet.headers)
    rows = "\n".join(
        f'<tr class="{row.state}"><td>{escape(BETWEEN.join(row.cells)).replace(BETWEEN, "</td><td>")}</td></tr>'
        for row in sheet.rows
    )
    reasons = _list(
        f'<li>{escape(reason)} <span class="about">{escape(names)}</span></li>' for reason, names in sheet.reasons
    )
    why = f"<h2>{escape(_('Why'))}</h2>{reasons}" if reasons else ""
    notes = "".join(f'<p class="note">{escape(note)}</p>' for note in sheet.notes)
    return (
        f"{HEAD}<title>{escape(sheet.title)}</title><style>{STYLE}</style></head>\n<body><h1>{escape(sheet.title)}</h1>"
        f'<p class="who"><b><bdi>{escape(sheet.student)}</bdi></b><br>{escape(sheet.total)}</p>{problems}\n'
        f"<table><thead><tr>{header}</tr></thead><tbody>\n{rows}\n</tbody></table>{why}{notes}</body></html>\n"
    )


def _list(items: Iterable[str]) -> str:
    found = "\n".join(items)
    return f"<ul>{found}</ul>" if found else ""
