"""Assembles the source of the site for mdbook, and checks the links of what mdbook makes of it. See site.sh.

    python site.py make FOLDER --signorini PROGRAM [--quick] [--new]
    python site.py check BOOK
"""

import argparse
import html.parser
import json
import pathlib
import re
import shutil
import subprocess
import sys
import textwrap
import time
import tomllib
import urllib.parse

ROOT = pathlib.Path(__file__).resolve().parents[1]
#: Parts of the list of cases, and what a case of each has.
PARTS = ["Membranes", "Solids", "Ropes and beams", "Finite cells", "Paths on rigid bodies", "Scenes"]
FOLDER_OF_RUNS = "site-runs"
#: Characters in a line of what a command prints.
WIDTH = 100


def part_of(case: dict) -> str:
    """The part of the list that a case belongs to."""
    if "analysis" in case:
        return "Scenes" if case["analysis"] == "closest_pairs" else "Paths on rigid bodies"
    kinds = {kind for body in case["bodies"].values() for kind in body}
    for kind, part in (("membrane", 0), ("cells", 3), ("rope", 2), ("beam", 2)):
        if kind in kinds:
            return PARTS[part]
    return "Solids"


def address(part: str) -> str:
    """What the page of a part is called."""
    return "all-" + part.lower().replace(" ", "-")


def program(name: str, case: dict) -> str:
    """The case as a Python program."""
    import signorini as sg

    if part_of(case) == "Scenes":
        return f'import signorini as sg\n\nresult = sg.scene("gallery/{name}/case.toml")\n'
    text = sg.gallery(name).to_python() + "result = sg.run(problem)\n"
    return text + "fitted = sg.fit(problem)\n" if "fit" in case else text


def run(command: str, name: str, runs: pathlib.Path, again: bool) -> "pathlib.Path | None":
    """The folder of the results of a case; None where it does not run. What has been run by the same program is kept."""
    folder, log = runs / name, runs / f"{name}.log"
    newest = max((ROOT / "gallery" / name / "case.toml").stat().st_mtime, pathlib.Path(command).stat().st_mtime)
    if not again and log.is_file() and log.stat().st_mtime > newest:
        return folder
    shutil.rmtree(folder, ignore_errors=True)
    begin = time.monotonic()
    done = subprocess.run([command, "gallery", "run", name, "-o", folder], capture_output=True, text=True)
    print(f"{name}: {time.monotonic() - begin:.1f} s, status {done.returncode}", flush=True)
    if done.returncode != 0:
        print(done.stdout, done.stderr, sep="\n", file=sys.stderr)
        return None
    subprocess.run([command, "report", folder, "-o", folder / "report.html"], check=True, capture_output=True)
    log.write_text(done.stdout, encoding="utf-8")
    return folder


def wrapped(printed: str) -> str:
    """What a command prints, in lines that a page holds. Lines of tables begin with blanks and stay as they are."""
    lines = printed.strip("\n").split("\n")
    return "\n".join(line if line.startswith(" ") or not line else textwrap.fill(line, WIDTH, break_long_words=False) for line in lines)


def page(name: str, target: pathlib.Path, results: "pathlib.Path | None") -> "tuple[str, str]":
    """Writes the page of a case with its files; returns its part of the list and its title."""
    source = ROOT / "gallery" / name
    text = (source / "case.toml").read_text(encoding="utf-8")
    case = tomllib.loads(text)
    about = (source / "README.md").read_text(encoding="utf-8")
    picture = source / "picture.png"
    links = []
    printed = ""
    if results:
        first = json.loads((results / "summary.json").read_text(encoding="utf-8")).get("first_picture")
        picture = results / first if first else picture
        shutil.copy(results / "report.html", target / f"{name}.report.html")
        links.append(f"[Report of this run]({name}.report.html): the result to turn and cut, histories, checks.")
        printed = wrapped((results.parent / f"{name}.log").read_text(encoding="utf-8").replace(str(results), name))
    shutil.copy(picture, target / f"{name}{picture.suffix}")
    title = about.split("\n", 1)[0].lstrip("# ")
    about = about.replace("(picture.png)", f"({name}{picture.suffix})")
    # The command comes with what it prints.
    command = f"```sh\nsignorini gallery run {name}\n"
    about, _, rest = about.partition(command)
    rest = rest.partition("```")[0]
    sections = [about.strip(), *links, "## Run it", f"{command}{rest}```"]
    if printed:
        sections.append(f"```text\n{printed}\n```")
    others = [p.name for p in sorted(source.iterdir()) if p.name not in ("README.md", "case.toml", "expected.json", "picture.png")]
    if others:
        sections.append("Files beside the case: " + ", ".join(f"`gallery/{name}/{other}`" for other in others) + ".")
    sections += ["## The case file", f"```toml\n{text.strip()}\n```"]
    sections += ["## In Python", f"```python\n{program(name, case).strip()}\n```"]
    (target / f"{name}.md").write_text("\n\n".join(sections) + "\n", encoding="utf-8")
    return part_of(case), title


def gallery(target: pathlib.Path, command: str, quick: bool, again: bool) -> "list[tuple[str, str, str]]":
    """Writes the pages of all cases and their list; returns part, name and title of each."""
    listed = json.loads(subprocess.run([command, "gallery", "--json"], check=True, capture_output=True, text=True).stdout)
    names = [entry["name"] for entry in listed]
    runs = target.resolve().parent / FOLDER_OF_RUNS
    folder = target / "gallery"
    folder.mkdir(parents=True)
    runs.mkdir(exist_ok=True)
    found, failed = [], []
    for name in names:
        results = None if quick else run(command, name, runs, again)
        if results is None and not quick:
            failed.append(name)
        found.append((name, *page(name, folder, results)))
    if failed:
        sys.exit(f"these cases do not run: {', '.join(failed)}")
    lines = ["# Gallery", "", "Every case runs with `signorini gallery run NAME`. Its page has the result, the case file, and the same in Python.", ""]
    for part in PARTS:
        listed = ['<div class="gallery">']
        for name, of, title in found:
            if of == part:
                image = next(p for p in folder.glob(f"{name}.*") if p.suffix in (".png", ".svg"))
                listed.append(f'<a href="{name}.html"><img src="{image.name}" alt="" loading="lazy"><span>{title}</span></a>')
        listed += ["</div>", ""]
        lines += [f"## {part}", "", *listed]
        (folder / f"{address(part)}.md").write_text("\n".join([f"# {part}", "", *listed]), encoding="utf-8")
    (folder / "index.md").write_text("\n".join(lines), encoding="utf-8")
    return [(part, name, title) for name, part, title in found]


def verified(target: pathlib.Path, command: str) -> None:
    """The page of the problems with known answers, computed now."""
    done = subprocess.run([command, "verify", "--json"], capture_output=True, text=True)
    rows = json.loads(done.stdout)
    version = subprocess.run([command, "--version"], capture_output=True, text=True).stdout.strip()
    lines = [
        "# Problems with known answers",
        "",
        f"Computed when this site was built, by `signorini verify` ({version}). The same command runs them on any machine.",
        "",
        "| problem | found | exact | error | allowed | source of the exact value |",
        "|---|---|---|---|---|---|",
    ]
    for row in rows:
        numbers = f"{row['error']} | | | |"
        if "found" in row:
            found, exact = (f"{row[key]:.10g}" for key in ("found", "exact"))
            # A hyphen at which no line is broken.
            error, allowed = (re.sub(r"e-0?", "e\u2011", f"{row[key]:.1e}") for key in ("error", "allowed"))
            numbers = f"{found} | {exact} | {error} | {allowed} | {row['source']}"
        lines.append(f"| {row['problem']} | {numbers} |")
    right = sum(row["holds"] for row in rows)
    lines += ["", f"{right} of {len(rows)} hold.", ""]
    (target / "verify.md").write_text("\n".join(lines), encoding="utf-8")
    if right != len(rows):
        sys.exit("\n".join(lines))


def reproduced(target: pathlib.Path, command: str, again: bool) -> None:
    """The figures of the publication, computed now in place of those of the repository."""
    folder = target.resolve().parent / FOLDER_OF_RUNS / "validation"
    done = folder / "done"
    if again or not done.is_file() or done.stat().st_mtime < pathlib.Path(command).stat().st_mtime:
        shutil.rmtree(folder, ignore_errors=True)
        subprocess.run([command, "reproduce", "all", "-o", folder], check=True, capture_output=True)
        done.touch()
    for path in [*folder.glob("*.md"), *folder.glob("*.svg")]:
        shutil.copy(path, target / "validation")


def make(target: pathlib.Path, command: str, quick: bool, again: bool) -> None:
    """The source of the site: a copy of the manual, with the pages that are computed."""
    shutil.rmtree(target, ignore_errors=True)
    shutil.copytree(ROOT / "docs", target)
    cases = gallery(target, command, quick, again)
    verified(target, command)
    if not quick:
        reproduced(target, command, again)
    # Cases that the manual names lead to their pages.
    known = {name for _, name, _ in cases}
    for path in target.rglob("*.md"):
        if path.parent.name == "gallery" or path.name == "SUMMARY.md":
            continue
        up = "../" * (len(path.relative_to(target).parts) - 1)
        text = path.read_text(encoding="utf-8")
        blocks = text.split("```")
        blocks[::2] = [
            re.sub(r"(?<!\[)`gallery/(\w+)`", lambda m: f"[{m[0]}]({up}gallery/{m[1]}.md)" if m[1] in known else m[0], block)
            for block in blocks[::2]
        ]
        path.write_text("```".join(blocks), encoding="utf-8")
    summary = (target / "SUMMARY.md").read_text(encoding="utf-8")
    listed = ["# Gallery", "", "- [All cases](gallery/index.md)"]
    for part in PARTS:
        listed.append(f"- [{part}](gallery/{address(part)}.md)")
        listed += [f"  - [{title}](gallery/{name}.md)" for of, name, title in cases if of == part]
    summary = summary.replace("# Reference\n", "\n".join(listed) + "\n\n# Reference\n", 1)
    summary = re.sub(r"(- \[Validation\]\(validation.md\)\n)", r"\1  - [Problems with known answers](verify.md)\n", summary)
    (target / "SUMMARY.md").write_text(summary, encoding="utf-8")


class Links(html.parser.HTMLParser):
    """What a page refers to, and the places that it has."""

    def __init__(self) -> None:
        super().__init__()
        self.links: "list[str]" = []
        self.places: "set[str]" = set()

    def handle_starttag(self, tag, attributes):
        values = dict(attributes)
        self.links += [values[key] for key in ("href", "src") if values.get(key) is not None]
        self.places |= {values[key] for key in ("id", "name") if values.get(key)}


def check(book: pathlib.Path) -> None:
    """Fails for links that lead nowhere, and for pages that load anything from elsewhere."""
    pages = {}
    for path in sorted(book.rglob("*.html")):
        # Reports are tested on their own; the page for wrong addresses has another root.
        if path.name.endswith(".report.html") or path.name == "404.html":
            continue
        pages[path.resolve()] = found = Links()
        found.feed(path.read_text(encoding="utf-8"))
    broken, count = [], 0
    for path, found in pages.items():
        for link in found.links:
            parts = urllib.parse.urlsplit(link)
            if parts.scheme in ("http", "https", "mailto", "data"):
                continue
            count += 1
            target = (path.parent / urllib.parse.unquote(parts.path)).resolve() if parts.path else path
            place = urllib.parse.unquote(parts.fragment)
            if not target.is_file() or (place and target in pages and place not in pages[target].places):
                broken.append(f"{path.relative_to(book.resolve())}: {link}")
    print(f"{len(pages)} pages, {count} links, {len(broken)} broken")
    if broken:
        sys.exit("\n".join(sorted(set(broken))))


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    actions = parser.add_subparsers(dest="action", required=True)
    making = actions.add_parser("make")
    making.add_argument("folder", type=pathlib.Path)
    making.add_argument("--signorini", required=True)
    making.add_argument("--quick", action="store_true")
    making.add_argument("--new", action="store_true")
    checking = actions.add_parser("check")
    checking.add_argument("folder", type=pathlib.Path)
    given = parser.parse_args()
    if given.action == "make":
        make(given.folder, given.signorini, given.quick, given.new)
    else:
        check(given.folder)
