"""British spellings, which documentation and interface must not have: they are in American English."""

import ast
import re
from pathlib import Path

# Stems: the word may go on ("colour" finds "colours" and "coloured").
_OUR = "armour behaviour colour favour flavour harbour honour humour labour neighbour vapour vigour"
_ISE = (
    "authoris capitalis categoris characteris criticis customis discretis equalis factoris finalis generalis "
    "initialis linearis localis maximis minimis normalis optimis organis orthogonalis parallelis parameteris "
    "parametris penalis polaris prioritis quantis randomis realis recognis regularis serialis specialis "
    "stabilis standardis summaris symmetris synchronis triangularis utilis vectoris visualis voxelis"
)
# Not "cancelled": Blender's own interface has it.
_DOUBLED = "labelle labelli levelle levelli modelle modelli signalle signalli travelle travelli"
# Whole words.
_WORDS = (
    "analyse analysed analyses analysing barycentre barycentres catalogue centre centred centres centring "
    "circumcentre circumcentres defence disc discs dialogue fibre fibres fulfil grey greyscale judgement "
    "learnt licence licences licenced litre litres metre metres millimetre millimetres mould moulds "
    "artefact artefacts offence practise programme programmes sceptical towards whence whilst amongst"
)
# "Analyses" is also the plural of "analysis", and these go on like a stem but are American.
_AMERICAN = {"analyses", "realism", "realistic", "optimistic", "polaris", "generalist", "specialist"}

BRITISH = re.compile(
    rf"(?<![a-z])(?:(?:(?:de|re|un|pre)?(?:{'|'.join((_OUR + ' ' + _ISE + ' ' + _DOUBLED).split())})[a-z]*)"
    rf"|(?:{'|'.join(_WORDS.split())})(?![a-z]))",
    re.IGNORECASE,
)


_FENCED = re.compile(r"^```.*?^```$", re.MULTILINE | re.DOTALL)


def british_words(text: str) -> list[str]:
    """The British spellings in a text, in their order."""
    return [word for word in BRITISH.findall(text) if word.lower() not in _AMERICAN]


def british_lines(path: Path) -> list[str]:
    """Where a page has British spellings outside code: its name, the line's number, and the words."""
    text = _FENCED.sub(lambda code: "\n" * code[0].count("\n"), path.read_text(encoding="utf-8"))
    lines = text.splitlines()
    found = ((number, british_words(re.sub("`[^`]*`", "", line))) for number, line in enumerate(lines, 1))
    return [f"{path.name}:{number}: {', '.join(words)}" for number, words in found if words]


def british_strings(path: Path) -> list[str]:
    """Where the strings of a Python file, which users may see, have British spellings."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    constants = (node for node in ast.walk(tree) if isinstance(node, ast.Constant))
    strings = (node for node in constants if isinstance(node.value, str))
    found = ((node.lineno, british_words(node.value)) for node in strings)
    return [f"{path.name}:{number}: {', '.join(words)}" for number, words in found if words]
