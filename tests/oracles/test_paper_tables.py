"""The counts of docs/paper-tables.md are what the program gives now. Its times are not checked."""

import sys

from conftest import ROOT

sys.path.insert(0, str(ROOT / "benchmarks"))
import paper_tables  # noqa: E402

ROWS = 5 * 4 + 6 * 2 * 4


def rows_of(page):
    """The cells of the tables' rows, without the times."""
    lines = [line for line in page.splitlines() if line.startswith("|")]
    cells = [[cell.strip() for cell in line.strip("|").split("|")] for line in lines]
    tables = [row for row in cells if len(row) == len(paper_tables.HEADER)]
    assert tables.count(paper_tables.HEADER) == 2
    times = paper_tables.HEADER.index("ms")
    return [row[:times] for row in tables if row != paper_tables.HEADER and not row[0].startswith("---")]


def test_planes_and_shares_are_what_the_program_gives(program, data, tell):
    page = rows_of(paper_tables.PAGE.read_text(encoding="utf-8"))
    cases = list(paper_tables.cases())
    now = [paper_tables.keys(case) + paper_tables.counted(paper_tables.detect(program, data, case)) for case in cases]
    tell(f"{len(now)} rows of docs/paper-tables.md:")
    assert len(page) == len(now) == ROWS
    for shown, given in zip(page, now):
        assert shown == given, "benchmarks/paper_tables.py writes the page anew"
    assert all(int(row[paper_tables.HEADER.index("planes")]) > 0 for row in now)


def test_every_map_of_the_page_has_a_note_on_what_is_seen():
    names = [name for name, _ in paper_tables.files()]
    assert len(names) == len(set(names)) == 11
    assert set(names) == set(paper_tables.SEEN)
    page = paper_tables.PAGE.read_text(encoding="utf-8")
    assert all(paper_tables.SEEN[name] in page for name in names)
