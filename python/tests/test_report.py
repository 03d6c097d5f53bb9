"""Reports: results as one HTML page, in memory and from a folder."""

import json
import pathlib
import pickle
import re

import pytest

import signorini as sg


def looks(html):
    """Names and looks of what the view of a page shows."""
    data = json.loads(re.search(r'id="data">(.*?)</script>', html, re.S).group(1))
    return {(part["name"], part["look"]) for part in data["scene"]["parts"]}


@pytest.mark.parametrize("name, wanted", [
    ("string", {("film", "membrane"), ("floor", "rigid"), ("contact", "outline")}),
    ("patch_test", {("lower", "solid"), ("upper", "solid")}),
    ("crossing", {("lower", "curve"), ("upper", "curve")}),
])
def test_a_result_in_memory_becomes_a_page(name, wanted, tmp_path):
    result = sg.run(sg.gallery(name), pictures=False)
    path = result.report(tmp_path / "page.html")
    html = path.read_text(encoding="utf-8")
    assert isinstance(path, pathlib.Path) and path == tmp_path / "page.html"
    assert result.verdict.split()[0].strip("`") in html and html.endswith("</html>\n")
    found = looks(html)
    assert {look for _, look in wanted} <= {look for _, look in found}, found
    names = {part for part, look in found if look in ("solid", "membrane", "curve")}
    assert names == {body for body in result.bodies}, found


def test_a_result_of_a_folder_is_reported_there(tmp_path):
    result = sg.run(sg.gallery("string"), tmp_path / "out", pictures=False)
    assert result.report() == tmp_path / "out" / "report.html"
    again = sg.run(sg.gallery("string"), tmp_path / "out", pictures=False)
    assert not (tmp_path / "out" / "report.html").exists()
    assert again.report(tmp_path / "other.html").exists()


def test_paths_and_pickled_results(tmp_path):
    drum = sg.Cylinder(point=[0, 0, 0], axis=[0, 1, 0], radius=1)
    result = sg.wrap([-2, 0, 0.5], [2, 0, 0.5], {"drum": drum})
    html = pickle.loads(pickle.dumps(result)).report(tmp_path / "path.html").read_text(encoding="utf-8")
    assert {("drum", "rigid"), ("path", "curve")} <= looks(html)


def test_what_cannot_be_written_is_told(tmp_path):
    result = sg.run(sg.gallery("string"), pictures=False)
    with pytest.raises(sg.OutputError, match="help"):
        result.report(tmp_path / "nothing" / "page.html")


def test_pictures_are_drawn_from_results(tmp_path):
    result = sg.run(sg.gallery("string"), tmp_path / "out", pictures=False)
    picture = result.draw(tmp_path / "a.png", field="contact_pressure", time="last")
    assert picture.startswith(b"\x89PNG") and (tmp_path / "a.png").read_bytes() == picture
    assert sg.draw(tmp_path / "out", field="contact_pressure").startswith(b"\x89PNG")
    with pytest.raises(sg.OutputError, match="no field `pressure`"):
        sg.draw(tmp_path / "out", field="pressure")
