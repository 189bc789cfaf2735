#!/usr/bin/env python3
# SPDX-FileCopyrightText: The marey authors
# SPDX-License-Identifier: Apache-2.0
"""language_scan.py ROOT [--list KIND [PREFIX]] [--check CEILINGS]

Counts sentences that break the rules of plain technical English in docs/conventions.md.
Kinds:
  headers        comments of *.h
  sources        comments of *.cpp, *.ts, *.js, *.mjs and *.css
  messages       string literals of *.h and *.cpp
  pages          string and template literals of *.ts, *.js and *.mjs, text of *.html
  docs           *.md
  scripts        comments and string literals of CMake files and of Python and shell scripts,
                 and comments of *.toml
  tests          names of tests in tests/**/*.cpp, split into words
  test_messages  string literals of tests (also of the page's), benchmarks and examples
Prints for each kind the number of sentences, the number with at least one idiom and the share
in percent. --list prints the sentences of one kind, optionally only of files whose path begins
with PREFIX. --check fails when a share is above its ceiling (lines "KIND PERCENT"), or when a
kind has no sentences.
"""
import ast
import re
import sys
from pathlib import Path

ROOMS = ("core", "capture", "calib", "reconstruct", "retarget", "recordings", "live",
         "dynamics", "edit", "engine", "library", "app")
TESTS = ("tests", "benchmarks", "examples")
KINDS = ("headers", "sources", "messages", "pages", "docs", "scripts", "tests",
         "test_messages")
# Folders of installed packages and of built pages.
NOT_OURS = {"node_modules", "dist", "dist-test"}

# Each idiom: its name, and the pattern that finds it in one sentence.
IDIOMS = {
    # Rule 1: a comment begins with a verb or a noun.
    "begins with a relative word": re.compile(
        r"^(?:What|Who|Whom|Whose|Of|Nor|Whether|Wherever|Whoever|Those|By which|From which|"
        r"With which|In which|To which|How)\b(?![^.]*\?$)|"
        # "Where" opens a clause with a comma and a main clause behind it, or a fragment.
        r"^Where (?!is \.\.\.)(?:[^,;]*$|[^,:;]*\b(?:is|are|was|were)[,:;])"),
    # Rule 2: no headless relative clauses.
    "headless relative clause": re.compile(
        r"(?<![\w-])(?:of|from|by|with|for|to|in|on|at|into|than|and|or|as|is|are|that|only|"
        r"after|before|beyond|about|under|like|but) what (?!it\b|if\b|is needed)|"
        r"(?<![\w-])(?:those|that|he|him|somebody|nobody|everybody|all|none) (?:who|whom)\b|"
        r"(?<!\w)what (?:lies|stands|follows|comes?|came|goes|one|they|its|his|their)\b|"
        r"^who |[.;,:] who \b|\bby what\b|\bof what\b|\bthose that\b|\bthat which\b|"
        r"\bof whom\b|\bwhoever\b|\bwherever\b", re.I),
    # Rule 3: data is computed, stored, sent, received, reported.
    "data as a speaker": re.compile(
        r"\b(?:tells?|told|telling|hears?|heard|hearing|says|said|believes?|believed|"
        r"believing|doubts?|doubted|doubtful|suffers?|suffered|is asked|are asked|asked of|"
        r"asks of|knows nothing|know nothing|lends?|lent|heeds?|heeded|owes?|owed|"
        r"is forgotten|are forgotten|learns?|gives? it up|speaks?|spoken)\b", re.I),
    # Rule 4: the term of the field, not a metaphor.
    "metaphor": re.compile(
        r"\b(?:habits?|houses?|seats?|doors?|doorman|bells?|temper|strangers?|brisk(?:er)?|"
        r"in good faith|wakes? up|falls? asleep|honest(?:ly)?|give up hope|at home)\b(?!-)",
        re.I),
    # Rule 5: no archaisms.
    "archaism": re.compile(
        r"\b(?:anew|likewise|beside|nobody|nobody's|somebody|somebody's|everybody|lately|"
        r"fares?|in vain|give or take|mend(?:s|ed|ing)?|thereof|therein|whence|wherein|whereby|"
        r"upon|amid|whilst|aught|naught|nought|for want of|by and by|ever so|all the same|"
        r"none the less|go(?:es)? without saying|needs must|save for|at most so many|so long "
        r"as)\b", re.I),
    # Inverted order of words.
    "inversion": re.compile(
        r"(?:^|[.;:] )(?:nor|seldom|only then|not until|of these|of this|of that|of them|of it|"
        r"of each|of all|of several|of two|of both|of one|of a|of the|of an|of every|of any|"
        r"were it|had it|should it|so (?:is|are|do|does|has|have)|as (?:is|are|do|does)|"
        r"there is none)\b", re.I),
    "old auxiliary": re.compile(
        r"\bneed not\b|\bhas to be\b(?= (?:said|told|asked))|\bso much as\b|\bas it were\b|"
        r"\bis for others\b|\bis not for\b|\bhave it so\b|\bis to be had\b|"
        r"\bas one (?:is|has|does)\b", re.I),
}
# Words of rule 3 and 4 that are terms in these phrases.
TERMS = re.compile(
    r"unknowns?|well[- ]known|known|ground truth|knowledge|silent (?:frame|data)|"
    r"boundary layer|asks? (?:for )?(?:permission|the user)|guess(?:es)? the|initial guess|"
    r"first guess|want(?:s)? to|you want|you know|out of the house", re.I)


def sentences(text):
    """Splits text into sentences of at least three words."""
    text = re.sub(r"`[^`]*`", "CODE", text)
    text = re.sub(r"\s+", " ", text)
    parts = re.split(r"(?<=[.!?:])\s+(?=[A-Z\"'(`\[])", text)
    return [p.strip() for p in parts if len(p.split()) >= 3]


def comment_sentences(text, marks):
    """Comments that `marks` finds, on lines of their own or behind code; adjacent lines are
    one text."""
    block, found = [], []
    for line in text.splitlines():
        match = marks.search(line)
        comment = match.group(1).strip() if match else None
        if comment is not None and comment.startswith(("SPDX-", "NOLINT", "clang-format")):
            comment = None
        if comment:
            if match.start(1) > 0 and line[:match.start()].strip() and block:
                found += sentences(" ".join(block))
                block = []
            block.append(comment)
        elif block:
            found += sentences(" ".join(block))
            block = []
    return found + sentences(" ".join(block))


LINE_COMMENT = re.compile(r"(?:^|\s)//[/!<]*\s?(.*)$")
SCRIPT_COMMENT = re.compile(
    r"(?:(?:^|\s)(?://+|/\*{1,2}(?!/))|^\s*\*{1,2}(?!/))\s?(.*?)(?:\*/)?$")
STRING = re.compile(r'"((?:[^"\\\n]|\\.)*)"')


def literal_sentences(literals):
    """Sentences of string literals with at least four words."""
    found = []
    for literal in literals:
        literal = literal.replace("\\n", " ").replace('\\"', '"')
        if len(literal.split()) >= 4:
            found += sentences(literal)
    return found


def message_sentences(text):
    """Text of adjacent string literals of C++, comments removed."""
    text = "\n".join(re.sub(r"(?:^|\s)//.*$", "", line) for line in text.splitlines()
                     if not line.lstrip().startswith("#include"))
    return literal_sentences(STRING.findall(re.sub(r'"\s*\n\s*"', "", text)))


QUOTED = re.compile(r'"((?:[^"\\\n]|\\.)*)"|\'((?:[^\'\\\n]|\\.)*)\'|`((?:[^`\\]|\\.)*)`')
# An expression in a template literal, without further expressions in it.
EXPRESSION = re.compile(r"\$\{((?:[^{}`]|`[^`$]*`)*)\}")


# Literals, stored as \0NUMBER\0, that `+` joins, also with a value between them.
JOINED = re.compile(r"\0\d+\0(?:\s*\+\s*(?:[\w.()\[\]]+\s*\+\s*)?\0\d+\0)*")


def page_literal_sentences(text):
    """Text of string and template literals of TypeScript and JavaScript."""
    text = re.sub(r"/\*.*?\*/", "", text, flags=re.S)
    text = re.sub(r"(?:^|(?<=\s))//.*$", "", text, flags=re.M)
    literals = []

    def store(match):
        literals.append("".join(group or "" for group in match.groups()))
        return f"\0{len(literals) - 1}\0"

    expressions = []
    while EXPRESSION.search(text):
        expressions += [QUOTED.sub(store, found) for found in EXPRESSION.findall(text)]
        text = EXPRESSION.sub("VALUE", text)
    text = QUOTED.sub(store, text)
    found = []
    for run in JOINED.findall("\n".join([text] + expressions)):
        run = re.sub(r"(?<=\0)\s*\+\s*(?=\0)", "", run)
        run = re.sub(r"(?<=\0)\s*\+[^\0]+\+\s*(?=\0)", "VALUE", run)
        found += html_sentences(re.sub(r"\0(\d+)\0", lambda m: literals[int(m[1])], run))
    return found


def html_sentences(text):
    """Text between tags, and attributes that a page shows."""
    text = re.sub(r"<!--.*?-->|<(script|style).*?</\1>", "", text, flags=re.S)
    shown = re.findall(r'\b(?:title|alt|placeholder|aria-label|content)="([^"]*)"', text)
    blocks = re.split(r"</?(?!b>|i>|em>|strong>|code>|kbd>|a\b|span\b)[^>]*>", text)
    return [sentence for block in blocks + shown
            for sentence in sentences(re.sub(r"</?\w[^>]*>", "", block))]


HASH_COMMENT = re.compile(r"(?:^|\s)#(?!!)+\s?(.*)$")
MULTILINE_STRING = re.compile(r'"((?:[^"\\]|\\.)*)"')
PATTERN = re.compile(r"\(\?|\\[bsw]|\[\^")


def script_sentences(text):
    """Comments and string literals of CMake files and of shell scripts."""
    found = comment_sentences(text, HASH_COMMENT)
    text = re.sub(r"(?:^|(?<=\s))#.*$", "", text, flags=re.M)
    text = re.sub(r"\$\{?\w+\}?", "VALUE", text)
    text = re.sub(r'"\s*\n\s*"', "", text)
    literals = [literal for literal in MULTILINE_STRING.findall(text)
                if not PATTERN.search(literal)]
    return found + literal_sentences(literals)


def python_sentences(text):
    """Comments, docstrings and other string literals of Python; patterns are left out."""
    literals = [node.value for node in ast.walk(ast.parse(text))
                if isinstance(node, ast.Constant) and isinstance(node.value, str)
                and not PATTERN.search(node.value)]
    return comment_sentences(text, HASH_COMMENT) + literal_sentences(literals)


def markdown_sentences(text):
    """Prose and table cells; code blocks are left out."""
    text = re.sub(r"```.*?```", "", text, flags=re.S)
    found = []
    for block in re.split(r"\n\s*\n", text):
        if re.match(r"(?: {4}|\t)", block):
            continue
        for row in re.split(r"\n(?=\s*(?:[-*|#]|\d+\.) ?)", block):
            for cell in row.split("|"):
                found += sentences(re.sub(r"^\s*(?:[-*#]+|\d+\.)\s*", "", cell))
    return found


TEST_NAME = re.compile(r"^TEST(?:_[FP])?\(\s*\w+,\s*(\w+)\s*\)", re.M)
WORD_START = re.compile(r"(?<=[a-z0-9])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])")


def test_names(text):
    """Names of GoogleTest's tests as sentences: "RejectsAnEmptyFile" is "Rejects an empty
    file"."""
    return [WORD_START.sub(" ", name).capitalize() for name in TEST_NAME.findall(text)]


def files_of(root, folders, *patterns):
    """Files in these folders whose name fits one of the patterns."""
    for folder in folders:
        for pattern in patterns:
            for path in sorted((root / folder).rglob(pattern)):
                if path.is_file() and not NOT_OURS & set(path.relative_to(root).parts):
                    yield path


def scan(root):
    """Returns {kind: [(path, sentence, idioms)]}."""
    result = {kind: [] for kind in KINDS}

    def add(kind, path, reader, *options):
        for sentence in reader(path.read_text(), *options):
            plain = TERMS.sub("TERM", sentence)
            idioms = [name for name, pattern in IDIOMS.items() if pattern.search(plain)]
            result[kind].append((path.relative_to(root), sentence, idioms))

    for path in files_of(root, ROOMS, "*.h", "*.cpp"):
        kind = "headers" if path.suffix == ".h" else "sources"
        add(kind, path, comment_sentences, LINE_COMMENT)
        add("messages", path, message_sentences)
    for path in files_of(root, TESTS, "*.h", "*.cpp"):
        add("sources", path, comment_sentences, LINE_COMMENT)
        add("test_messages", path, message_sentences)
    for path in files_of(root, ("tests",), "*.cpp"):
        add("tests", path, test_names)
    for path in files_of(root, ROOMS + TESTS, "*.ts", "*.js", "*.mjs", "*.css"):
        add("sources", path, comment_sentences, SCRIPT_COMMENT)
        if path.suffix != ".css":
            of_page = not {"test", *TESTS} & set(path.relative_to(root).parts)
            add("pages" if of_page else "test_messages", path, page_literal_sentences)
    for path in files_of(root, ROOMS + TESTS, "*.html"):
        add("pages", path, html_sentences)
    everywhere = ROOMS + TESTS + ("cmake", "docs", "python")
    for path in sorted(root.glob("*.md")) + list(files_of(root, everywhere, "*.md")):
        add("docs", path, markdown_sentences)
    for path in files_of(root, everywhere, "*.py"):
        add("scripts", path, python_sentences)
    for path in files_of(root, everywhere, "*.toml"):
        add("scripts", path, comment_sentences, HASH_COMMENT)
    scripts = [root / "CMakeLists.txt", root / "run", root / ".ci/run"]
    scripts += files_of(root, everywhere, "CMakeLists.txt", "*.cmake", "*.sh")
    for path in scripts:
        if path.exists():
            add("scripts", path, script_sentences)
    return result


def main(arguments):
    root = Path(arguments[0])
    result = scan(root)
    if "--list" in arguments:
        rest = arguments[arguments.index("--list") + 1:]
        prefix = rest[1] if len(rest) > 1 else ""
        for path, sentence, idioms in result[rest[0]]:
            if idioms and str(path).startswith(prefix):
                print(f"{path}: [{'; '.join(idioms)}] {sentence}")
        return 0
    shares = {}
    for kind, rows in result.items():
        with_idiom = sum(1 for row in rows if row[2])
        shares[kind] = 100.0 * with_idiom / len(rows) if rows else None
        print(f"{kind}: {len(rows)} sentences, {with_idiom} with an idiom, "
              + (f"{shares[kind]:.2f} %" if rows else "nothing was checked"))
    if "--check" not in arguments:
        return 0
    failed = False
    for line in Path(arguments[arguments.index("--check") + 1]).read_text().splitlines():
        if not line or line.startswith("#"):
            continue
        kind, ceiling = line.split()
        if shares[kind] is None or shares[kind] > float(ceiling):
            print(f"error: {kind}: {shares[kind]} % is above the ceiling of {ceiling} %. "
                  f"Next: run with --list {kind}, and rewrite these sentences.")
            failed = True
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
