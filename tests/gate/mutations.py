"""Single edits of C code, by which `make mutate` tries the tests: mutations(text, lines) lists all of a file."""
import re
from collections import namedtuple

# text[start:end] becomes new; line is where it stands.
Mutation = namedtuple("Mutation", "line start end new kind")

SWAPS = {
    "<": "<=", "<=": "<", ">": ">=", ">=": ">", "==": "!=", "!=": "==", "&&": "||", "||": "&&", "+": "-", "-": "+",
    "*": "/", "/": "*", "+=": "-=", "-=": "+=", "*=": "/=", "/=": "*=", "&": "|", "|": "&", "<<": ">>", ">>": "<<",
    "++": "--", "--": "++", "fmin": "fmax", "fmax": "fmin", "fminf": "fmaxf", "fmaxf": "fminf", "true": "false",
    "false": "true",
}
# clang-format sets blanks around binary operators, and none after unary ones or the * of a pointer.
BINARY = re.compile(r"(?<=\s)(?:<=|>=|==|!=|&&|\|\||<<|>>|[-+*/]=|[-<>+*/&|])(?=\s)")
WORD = re.compile(r"\+\+|--|\b(?:fminf?|fmaxf?|true|false)\b")
NUMBER = re.compile(r"(?<![\w.])(\d+\.?\d*(?:[eE][-+]?\d+)?|\.\d+(?:[eE][-+]?\d+)?)([fFuUlL]*)(?![\w.])")
# Without free() programs do the same; lost memory is what valgrind and sanitizers find.
NO_STATEMENT = re.compile(r"(?:free|return|goto|case|default|if|else|for|while|do|switch|typedef|static|extern|struct|enum|union|const)\b")
ARRAY = r"\w+(?:\[\w+\])*\["
DECLARATION = re.compile(r"[A-Za-z_]\w*\s+\**[A-Za-z_]\w*|[A-Za-z_]\w*\s*\*+\s*[A-Za-z_]\w*\s*[=;,\[]")


def bare(text):
    """The text with blanks in place of comments, strings and directives: each character keeps its place."""
    pattern = r'/\*.*?\*/|//[^\n]*|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])*\'|^[ \t]*#(?:[^\n]*\\\n)*[^\n]*'

    def blank(match):
        return re.sub(r"[^\n]", "_" if match.group()[0] in "\"'" else " ", match.group())

    return re.sub(pattern, blank, text, flags=re.S | re.M)


def closing(code, start):
    """The place behind the parenthesis that closes the one at start."""
    depth = 0
    for at in range(start, len(code)):
        depth += (code[at] == "(") - (code[at] == ")")
        if depth == 0:
            return at + 1
    return None


def off_by_one(digits, suffix, is_negative):
    """A number's neighbours; of -1, which says that something failed, only 0: that it did not."""
    if is_negative and digits == "1":
        return [f"0{suffix}"]
    if re.fullmatch(r"\d+", digits):
        value = int(digits, 8 if len(digits) > 1 and digits[0] == "0" else 10)
        return [f"{value + 1}{suffix}", f"{value - 1}{suffix}" if value else f"(-1{suffix})"]
    return [f"({float(digits) + 1!r}{suffix})", f"({float(digits) - 1!r}{suffix})"]


def statements(code):
    """Start and end of each statement that can be dropped: calls, assignments, break and continue."""
    before = "{"
    for match in re.finditer(r"[^\n]+", code):
        line = match.group()
        first = line.strip()
        if not first:
            continue
        if before[-1] in ";{}):" or before.endswith("else"):
            start = match.start() + len(line) - len(line.lstrip())
            end = code.find(";", start)
            statement = code[start:end + 1]
            if (end > 0 and statement.count("\n") < 5 and not re.search(r"[{}]", statement)
                    and statement.count("(") == statement.count(")") and len(statement) > 1
                    and not NO_STATEMENT.match(statement) and not DECLARATION.match(statement)
                    and re.fullmatch(r"\s*", code[end + 1:(code + "\n").find("\n", end)])):
                yield start, end + 1
        before = first


def mutations(text, lines):
    """All mutations that begin on one of the lines."""
    code = bare(text)
    starts = [0] + [match.end() for match in re.finditer("\n", text)]
    found = []

    def add(start, end, new, kind):
        low, high = 0, len(starts)
        while high - low > 1:
            middle = (low + high) // 2
            low, high = (middle, high) if starts[middle] <= start else (low, middle)
        if low + 1 in lines:
            found.append(Mutation(low + 1, start, end, new, kind))

    for pattern, kind in ((BINARY, "operator"), (WORD, "word")):
        for match in pattern.finditer(code):
            add(match.start(), match.end(), SWAPS[match.group()], kind)
    for match in NUMBER.finditer(code):
        line_start = code.rfind("\n", 0, match.start()) + 1
        before = code[line_start:match.start()].lstrip()
        if re.search(rf"\b(?!return|else|sizeof|case)[a-z]\w* \**{ARRAY}$", before) or (
                DECLARATION.match(before) and before.count("(") == before.count(")") and re.search(rf", \**{ARRAY}$", before)):
            continue  # the size of an array
        for new in off_by_one(*match.groups(), code[match.start() - 1] == "-"):
            add(match.start(), match.end(), new, "constant")
    for match in re.finditer(r"\b(?:if|while) \(", code):
        end = closing(code, match.end() - 1)
        if end:
            add(match.end() - 1, end, f"(!{text[match.end() - 1:end]})", "condition")
    for start, end in statements(code):
        add(start, end, ";", "statement")
    return sorted(found)
