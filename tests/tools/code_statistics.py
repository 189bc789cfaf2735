#!/usr/bin/env python3
# SPDX-FileCopyrightText: The marey authors
# SPDX-License-Identifier: Apache-2.0
"""code_statistics.py ROOT

Prints the size of the code below ROOT: files, lines and lines of code (neither blank nor
only comment) of each language and each top folder, the longest files, and the lengths of
the functions in C++ and TypeScript (median, 90th percentile, maximum; lines from the name
to the closing brace). Generated and installed files (build/, dist/, node_modules/,
package-lock.json) do not count. Functions need the command ctags (universal-ctags).
"""
import json
import shutil
import subprocess
import sys
from pathlib import Path

LANGUAGES = {".cpp": "C++", ".h": "C++", ".ts": "TypeScript", ".js": "JavaScript",
             ".mjs": "JavaScript", ".css": "CSS", ".html": "HTML", ".py": "Python",
             ".sh": "shell", ".cmake": "CMake"}
SKIPPED_FOLDERS = {"build", "dist", "dist-test", "node_modules", ".git", "third_party"}
COMMENT_STARTS = {"C++": ("//", "/*", "*"), "TypeScript": ("//", "/*", "*"),
                  "JavaScript": ("//", "/*", "*"), "CSS": ("/*", "*"), "HTML": ("<!--",),
                  "Python": ("#",), "shell": ("#",), "CMake": ("#",)}


def language_of(path):
    """Returns the language of a file, or None if it does not count as code."""
    if path.name == "CMakeLists.txt":
        return "CMake"
    if path.name == "run":
        return "shell"
    return LANGUAGES.get(path.suffix)


def source_files(root):
    """Yields (path, language) of every file that counts, in a fixed order."""
    for path in sorted(root.rglob("*")):
        parts = path.relative_to(root).parts
        if SKIPPED_FOLDERS & set(parts[:-1]) or not path.is_file():
            continue
        language = language_of(path)
        if language:
            yield path, language


def code_lines(lines, language):
    """Counts the lines that are neither blank nor only comment."""
    starts = COMMENT_STARTS[language]
    return sum(1 for line in lines if line.strip() and not line.strip().startswith(starts))


def percentile(values, share):
    """Returns the value below or at which `share` of the sorted values lie."""
    return values[min(len(values) - 1, int(share * len(values)))]


def function_lengths(paths):
    """Returns (lines, name, path) of every function definition, longest last."""
    run = subprocess.run(
        ["ctags", "--output-format=json", "--fields=+ne", "--kinds-C++=f",
         "--kinds-TypeScript=fm", "--langmap=C++:+.h", "--languages=C++,TypeScript",
         "-f", "-", "-L", "-"],
        input="\n".join(map(str, paths)), capture_output=True, text=True, check=True)
    tags = (json.loads(line) for line in run.stdout.splitlines())
    return sorted((tag["end"] - tag["line"] + 1, tag["name"], tag["path"])
                  for tag in tags if "end" in tag)


def print_table(title, rows):
    print(f"{title:<14}{'files':>8}{'lines':>10}{'code lines':>12}")
    for name in sorted(rows, key=lambda name: -rows[name][1]):
        files, lines, code = rows[name]
        print(f"{name:<14}{files:>8}{lines:>10}{code:>12}")
    totals = [sum(row[i] for row in rows.values()) for i in range(3)]
    print(f"{'total':<14}{totals[0]:>8}{totals[1]:>10}{totals[2]:>12}\n")


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    root = Path(sys.argv[1])
    languages, folders, lengths, ctags_paths = {}, {}, [], []
    for path, language in source_files(root):
        lines = path.read_text(encoding="utf-8", errors="replace").splitlines()
        parts = path.relative_to(root).parts
        counts = (1, len(lines), code_lines(lines, language))
        for table, key in ((languages, language), (folders, parts[0] if parts[1:] else ".")):
            table[key] = [a + b for a, b in zip(table.get(key, (0, 0, 0)), counts)]
        lengths.append((len(lines), str(path.relative_to(root))))
        if language in ("C++", "TypeScript"):
            ctags_paths.append(path)
    if not lengths:
        sys.exit(f"{root}: no source files")
    print_table("language", languages)
    print_table("folder", folders)
    lengths.sort()
    counts = [count for count, _ in lengths]
    print(f"file length: median {percentile(counts, 0.5)}, 90 % {percentile(counts, 0.9)}, "
          f"maximum {counts[-1]} lines; longest:")
    for count, name in lengths[:-4:-1]:
        print(f"{count:>6}  {name}")
    if not shutil.which("ctags"):
        sys.exit("ctags is missing: no lengths of functions. Next: install universal-ctags.")
    functions = function_lengths(ctags_paths)
    counts = [count for count, _, _ in functions]
    print(f"functions: {len(functions)}; length: median {percentile(counts, 0.5)}, 90 % "
          f"{percentile(counts, 0.9)}, maximum {counts[-1]} lines; longest:")
    for count, name, path in functions[:-4:-1]:
        print(f"{count:>6}  {name} ({Path(path).relative_to(root)})")


if __name__ == "__main__":
    main()
