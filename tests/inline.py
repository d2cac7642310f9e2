#!/usr/bin/env python3
"""Takes #[inline(always)] away from functions of the core, prints what that costs, and puts it back.

usage: tests/inline.py [--short] [--frames] [--keep] PLACE...

PLACE is a file or folder of shared/src, or FILE:FUNCTION. Its functions get #[inline] instead. Functions with #[inline] may be about six times as large
as others before the compiler refuses to inline them. The places are taken away together: a function often costs more alone than together with others.
--short   only functions whose body is one line
--frames  also counts instructions of the recorded frames, by target/stress/microphong: cargo build --profile stress --features boards
--keep    does not put it back

Prints which of the functions are then called in firmware: these need the attribute. Prints flash of programs, and frames that change by over 0.1 %.
"""
import csv, json, os, re, shutil, subprocess, sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
SOURCE, TARGET = ROOT / "shared/src", Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target"))
BOARDS = [("pico", "thumbv6m-none-eabi"), ("mps2-an385", "thumbv7m-none-eabi")]
PROGRAMS = ["gouraud-binary", "gouraud-rgb565", "phong-rgb565", "auto-linear-rgb565", "auto-rgb565"]


def attributes(lines, short):
    """Numbers of lines with the attribute, and the functions' names."""
    for at in (n for n, line in enumerate(lines) if line.strip() == "#[inline(always)]"):
        fn = next(n for n in range(at, len(lines)) if re.search(r"\bfn \w", lines[n]))
        body = next(n for n in range(fn, len(lines)) if lines[n].endswith(("{", "}")))
        if short and lines[body + 2].strip() != "}":
            continue
        yield at, re.search(r"\bfn (\w+)", lines[fn])[1]


def edit(path, name, short):
    lines = path.read_text().split("\n")
    found = [a for a in attributes(lines, short) if name in ("", a[1])]
    for at, _ in found:
        lines[at] = lines[at].replace("#[inline(always)]", "#[inline]")
    path.write_text("\n".join(lines))
    return {(str(path.relative_to(SOURCE)), name) for _, name in found}


def run(*command, **options):
    return subprocess.run(command, check=True, text=True, stdout=subprocess.PIPE, **options).stdout


def build(packages, features, target, directory):
    flags = ["--no-default-features", "--features", features, "--target", target, "--target-dir", directory]
    run("cargo", "build", "--quiet", "--release", *packages, *flags, cwd=ROOT / "firmware")
    return Path(directory) / target / "release"


def called(program):
    """Files and names of functions of the core in a program."""
    addresses = "\n".join("0x" + symbol.split()[0] for symbol in run("llvm-nm", program).split("\n") if re.search(" [tT] _.*microphong", symbol))
    lines = run("llvm-symbolizer", "-e", program, "--output-style=JSON", input=addresses).splitlines()
    frames = [json.loads(line)["Symbol"][-1] for line in lines if '"Symbol":[{' in line]
    name = lambda f: re.sub(r"::<.*", "", re.sub(r"^<.*?>(?=::\w+(::<|$))", "", f["FunctionName"])).rsplit("::", 1)[-1]
    return {(f["FileName"].split("shared/src/")[-1], name(f)) for f in frames if "shared/src/" in f["FileName"]}


def measure(frames, figures, table=TARGET / "inline.csv"):
    functions = [called(build(["--workspace", "--bin", b], f"microphong-firmware/{b}", t, ROOT / "target/firmware") / b) for b, t in BOARDS]
    made = build(["-p", "size", "--bins"], "size/full", "thumbv6m-none-eabi", TARGET / "inline")
    for p in PROGRAMS:
        sections = re.findall(r"^\.(?:vector_table|text|rodata|data)\s+(\d+)", run("llvm-size", "-A", made / p), re.M)
        figures[f"flash of {p}"] = sum(map(int, sections))
    if frames:
        shutil.copy(ROOT / "tests/baselines/costs.csv", table)
        run(TARGET / "stress/microphong", "bench", "--renew", table, "--reason", "-", cwd=ROOT)
        figures.update({f"{r['board']} {r['scene']} {r['shader']}": int(r["instructions"]) for r in csv.DictReader(table.open())})
    return set.union(*functions), figures


def main(places, short, frames, keep):
    (before, was), texts, taken = measure(frames, {}), {}, set()
    try:
        for place, _, name in (p.partition(":") for p in places):
            for path in sorted((SOURCE / place).rglob("*.rs")) or [SOURCE / place]:
                texts.setdefault(path, path.read_text())
                taken |= edit(path, name, short)
        after, now = measure(frames, {})
        print(len(taken), "names of functions; called:", *sorted(":".join(f) for f in (after - before) & taken))
        changes = [(now[what] * 100 / old - 100, what) for what, old in was.items()]
        print(*(f"{c:+.2f} % {what}: {now[what]}" for c, what in changes if abs(c) > 0.1 or "flash" in what), sep="\n")
        print(f"mean of frames: {sum(c for c, _ in changes[5:]) / len(changes[5:]):+.3f} %" if frames else "")
    finally:
        for path, text in [] if keep else texts.items():
            path.write_text(text)


options = ["--short", "--frames", "--keep"]
given = [a for a in sys.argv[1:] if a not in options]
sys.exit(main(given, *(o in sys.argv for o in options)) if given and given[0][0] != "-" else __doc__)
