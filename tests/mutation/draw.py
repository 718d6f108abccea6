"""Finds mutants of the lines of a source, and makes text that contains both line and mutant.

Begin reading at candidates(). There is no parser of C++: operators are found by the spaces that
clang-format puts around them, and mutate.py replaces mutants that do not compile by others.
"""
import random
import re
from collections import Counter
from dataclasses import dataclass

SPACE = "::sunder::mutants::"

# Operator -> its replacements, each with the type of mutant.h that has both.
BINARY = {
    "+": [("-", "PlusToMinus")], "-": [("+", "MinusToPlus")],
    "*": [("/", "TimesToOver")], "/": [("*", "OverToTimes")],
    "<": [("<=", "LessToAtMost"), (">", "LessToMore")],
    ">": [(">=", "MoreToAtLeast"), ("<", "MoreToLess")],
    "<=": [("<", "AtMostToLess"), (">=", "AtMostToAtLeast")],
    ">=": [(">", "AtLeastToMore"), ("<=", "AtLeastToAtMost")],
    "==": [("!=", "EqualToUnequal")], "!=": [("==", "UnequalToEqual")],
}
# Lines whose change no test should notice: declarations, checks, messages, memory, tracing.
SKIPPED = re.compile(r"^\s*#|\b(constexpr|static_assert|SUNDER_CHECK|reserve|shrink_to_fit|trace|"
                     r"template|using|typedef|namespace|throw|InputError|friend|default|TraceScope|"
                     r"for_chunks|prefetch|__builtin_prefetch|requires|case)\b|"
                     r"^\s*(public|private):")

# Statements that are not dropped: declarations, and control statements, which contain others.
DECLARATION = re.compile(r"[\w:]+(<.*>)?(::\w+)?( ?[&*]+ ?| )\w+( = |$|[{(,;\[])")
NOTHING = re.compile(r"return( (\{\}|false|0u?|0\.0f?|nullptr|\w+::Zero\(\)))?")
KEYWORDS = ("if", "for", "while", "do", "else", "goto", "const", "auto", "struct", "switch",
            "static", "try", "catch")


@dataclass(frozen=True)
class Mutant:
    """One change of one line; `edit(k)` is the text for [start, end) with original and mutant."""
    path: str
    line: int
    kind: str
    start: int
    end: int
    before: str  # of the text [start, end)
    after: str
    template: str  # with {k} for the number

    def edit(self, k):
        return self.template.replace("{k}", str(k))

    def __str__(self):
        return f"{self.path}:{self.line}: {self.before}  ->  {self.after or 'nothing'}"


def masked(text):
    """Returns the text with comments, strings and preprocessor lines blanked, of equal length."""
    def blank(match):
        return re.sub(r"[^\n]", " ", match.group())

    def hollow(match):
        return '"' + re.sub(r"[^\n]", "_", match.group()[1:-1]) + '"'
    text = re.sub(r"//[^\n]*|/\*.*?\*/", blank, text, flags=re.S)
    text = re.sub(r'"(?:[^"\\\n]|\\.)*"', hollow, text)
    text = re.sub(r"(?<!\w)'(?:[^'\\\n]|\\.)'", hollow, text)
    return re.sub(r"^[ \t]*#(?:[^\n]*\\\n)*[^\n]*", blank, text, flags=re.M)


def in_bodies(code):
    """Returns for each character 1 if it is within the braces of a function, else 0."""
    inside, stack, head = bytearray(len(code)), [False], 0
    for i, c in enumerate(code):
        inside[i] = stack[-1]
        if c == "{":
            before = re.sub(r"template\s*<[^{};]*?>(?=\s*[\w\[])", "", code[head:i])
            declares = re.search(r"\b(namespace|struct|class|enum|union)\b", before)
            stack.append(stack[-1] and not declares or (not declares and ")" in before))
        elif c == "}" and len(stack) > 1:
            stack.pop()
        if c in "{};":
            head = i + 1
    return inside


def matching(code, i, step):
    """Returns the index of the bracket that matches the one at i."""
    depth = 0
    while 0 <= i < len(code):
        if code[i] in "([{":
            depth += 1
        elif code[i] in ")]}":
            depth -= 1
        if depth == 0:
            return i
        i += step
    return None


def operand_end(code, i, stops):
    """Returns the end of the expression that begins at i: one of `stops` or a bracket."""
    while i < len(code) and code[i] not in ")]}" and not re.match(stops, code[i:i + 3]):
        i = matching(code, i, 1) + 1 if code[i] in "([{" else i + 1
    return i


def operand_start(code, i, stops):
    """Returns the beginning of the expression that ends before i."""
    while i > 0 and code[i - 1] not in "([{" and not re.search(stops, code[max(0, i - 7):i]):
        i = matching(code, i - 1, -1) if code[i - 1] in ")]" else i - 1
        if code[i - 1] == "}":
            return i
    return i


def in_one_line(text):
    return re.sub(r"\s*\n\s*", " ", text.strip())


def keep_lines(new, old):
    """Returns `new` with the number of line ends of `old`."""
    return in_one_line(new) + "\n" * old.count("\n")


class Source:
    """A file and its possible mutants."""

    def __init__(self, path, text):
        self.path, self.text, self.code = path, text, masked(text)
        self.inside = in_bodies(self.code)
        self.found = []

    def offer(self, kind, start, end, after, template, shown=None):
        line = self.text.count("\n", 0, shown if shown is not None else start) + 1
        self.found.append(Mutant(self.path, line, kind, start, end,
                                 in_one_line(self.text[start:end]), after, template))

    def operators(self):
        for match in re.finditer(r"(?<=[\w)\]]) (\+|-|\*|/|<|>|<=|>=|==|!=)(?=\s+[\w(\-!*&+:])",
                                 self.code):
            for becomes, name in BINARY[match[1]]:
                self.offer(f"{match[1]} to {becomes}", match.start(1), match.end(1), becomes,
                           f"{match[1]} {SPACE}{name}<{{k}}>() {match[1]}")
        for match in re.finditer(r"(?<=[(,=?:\[])( ?)(-)(?=[A-Za-z(])|(?<=return )()(-)(?=[\w(])",
                                 self.code):
            at = match.start(2) if match[2] else match.start(4)
            self.offer("- dropped", at, at + 1, "", f"{SPACE}Negative<{{k}}>() * ")

    def assignments(self):
        for match in re.finditer(r" (\+=|-=) ", self.code):
            start = match.start()
            while start > 0 and re.match(r"[\w.:>*)\]-]", self.code[start - 1]):
                at_bracket = self.code[start - 1] in ")]"
                start = matching(self.code, start - 1, -1) if at_bracket else start - 1
            left, sign = self.text[start:match.start()], match[1]
            if "\n" in left or not left or self.code[start:].startswith("-"):
                continue
            self.offer(f"{sign} turned", start, match.end(1),
                       f"{left} {'-=' if sign == '+=' else '+='}",
                       f"{SPACE}sum<{{k}}>({left}) {sign}", match.start(1))

    def logic(self):
        for match in re.finditer(r" (&&|\|\|)(?=\s)", self.code):
            operator = match[1]
            stops = r"[,;?]| : |&&|\|\|" if operator == "&&" else r"[,;?]| : |\|\|"
            back = r"[,;{}?]$| : $| = $|\breturn $" + (r"|\|\| $" if operator == "&&" else "")
            start = operand_start(self.code, match.start(), back)
            end = operand_end(self.code, match.end(), stops)
            whole = self.text[start:end]
            if "//" in whole or "[&" in whole or "{" in whole or self.code[end - 1] == "&":
                continue
            left = in_one_line(self.text[start:match.start()])
            right = in_one_line(self.text[match.end():end])
            other = "||" if operator == "&&" else "&&"
            both = (f"({SPACE}on<{{k}}>() ? ({left}) {other} ({right}) : ({left}) {operator} "
                    f"({right}))")
            self.offer(f"{operator} to {other}", start, end, f"{left} {other} {right}",
                       keep_lines(both, whole), match.start(1))

    def literals(self):
        for match in re.finditer(r"\b(true|false)\b", self.code):
            self.offer("turned", *match.span(), "false" if match[1] == "true" else "true",
                       f"{SPACE}boolean<{{k}}>({match[1]})")
        for match in re.finditer(r"(?<![\w.])(\d+)(u|)(?![\w.'])", self.code):
            self.offer("next number", *match.span(), f"{int(match[1]) + 1}{match[2]}",
                       f"{SPACE}next<{{k}}>({match[0]})")
        for match in re.finditer(r"(?<![\w.])(\d+\.\d*|\d+(?=e)|\.\d+)(e-?\d+)?(f?)(?![\w.])",
                                 self.code):
            if float(match[1]) != 0:
                self.offer("scaled", *match.span(), f"1.5 * {match[0]}",
                           f"{SPACE}more<{{k}}>({match[0]})")

    def calls(self):
        for match in re.finditer(r"\bstd::(max|min)(?=\()", self.code):
            end = matching(self.code, match.end(), 1)
            comma = operand_end(self.code, match.end() + 1, r",")
            if end is None or self.code[comma] != ",":
                continue
            self.offer(f"{match[0]} dropped", *match.span(),
                       in_one_line(self.text[match.end() + 1:comma]) + " alone",
                       f"{SPACE}Extreme<{{k}}, {'true' if match[1] == 'max' else 'false'}>()")

    def statements(self):
        for match in re.finditer(r"(?<=[;{})])(\s+|(?<=\))\s)(?=[\w*+(:-])|\belse (?=[\w*+(:-])",
                                 self.code):
            start = match.end()
            if not self.inside[start] or not self.in_block(start):
                continue
            end = operand_end(self.code, start, r"[;{]")
            if end >= len(self.code) or self.code[end] != ";":
                continue
            text, after_bracket = self.text[start:end], self.code[match.start() - 1] == ")"
            if after_bracket and not self.controlled(match.start() - 1):
                continue
            words = re.match(r"[\w:]+", text)
            word = words[0] if words else ""
            if "//" in text or word in KEYWORDS:
                continue
            if word == "return":
                if not NOTHING.fullmatch(text):
                    self.offer("returns nothing", start, end + 1, "return {};", keep_lines(
                        f"{{ if ({SPACE}on<{{k}}>()) return {{}}; {text}; }}", text))
                continue
            if DECLARATION.match(text):
                continue
            self.offer("dropped", start, end + 1, "",
                       keep_lines(f"{{ if (!{SPACE}on<{{k}}>()) {{ {text}; }} }}", text))
            self.offer("returns early", start, end + 1, "return;",
                       keep_lines(f"{{ if ({SPACE}on<{{k}}>()) return; {text}; }}", text))

    def in_block(self, i):
        """True if the innermost bracket around i is a brace, not that of a for statement."""
        depth = 0
        for c in reversed(self.code[max(0, i - 2000):i]):
            depth += (c in ")]}") - (c in "([{")
            if depth < 0:
                return c == "{"
        return False

    def controlled(self, close):
        """True if the bracket that closes here is that of an if, a for or a while."""
        opening = matching(self.code, close, -1)
        return bool(opening and re.search(r"\b(if|for|while)\s*$", self.code[:opening]))

    def conditions(self):
        for match in re.finditer(r"\bif \(", self.code):
            end = matching(self.code, match.end() - 1, 1)
            text = self.text[match.end():end]
            if ";" in text or "//" in text or " = " in text:
                continue
            self.offer("negated", match.end(), end, f"!({in_one_line(text)})", keep_lines(
                f"{SPACE}on<{{k}}>() != static_cast<bool>({text})", text))


def candidates(path, text):
    """Returns for each line with mutants its code, and its mutants in one list for each family."""
    source = Source(path, text)
    code_lines = source.code.split("\n")
    lines = {}
    for offers in (source.operators, source.assignments, source.logic, source.literals,
                   source.calls, source.statements, source.conditions):
        source.found = []
        offers()
        for mutant in source.found:
            if source.inside[mutant.start] and not SKIPPED.search(code_lines[mutant.line - 1]):
                families = lines.setdefault(mutant.line, {})
                families.setdefault(offers.__name__, []).append(mutant)
    return [(code_lines[line - 1].strip(), list(lines[line].values())) for line in sorted(lines)]


def draw(texts, folders, seed):
    """Yields one mutant of each line with mutants, in random order. The random number of a line
    depends on its text only, so that changes elsewhere do not change the order."""
    drawn, alike = [], Counter()
    for path in sorted(texts):
        inside = path.startswith(tuple(f"{folder}/" for folder in folders))
        if inside and path.endswith((".h", ".cpp")):
            for code, families in candidates(path, texts[path].decode()):
                alike[path, code] += 1
                rng = random.Random(f"{seed} {path} {code} {alike[path, code]}")
                drawn.append((rng.random(), rng.choice(rng.choice(families))))
    for _, mutant in sorted(drawn, key=lambda entry: entry[0]):
        yield mutant
