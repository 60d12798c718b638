"""The kernels' C text: the proof fails if the statements that it models are no longer there."""
import re

from tables import require

FILES = ("elementary_lanes", "elementary_kernel", "elementary_composed", "elementary_point", "power_kernel",
         "power_map")


class Source:
    def __init__(self, directory):
        self.text = "".join((directory / f"{name}.h").read_text() for name in FILES)
        self.text += (directory / "elementary_rare.c").read_text()

    def body(self, function):
        """The body of one function, white space made single."""
        found = re.search(rf"\b{function}\([^;{{]*\) {{(?:([^\n]+) }}\n|\n(.*?)\n}})", self.text, re.S)
        require(found, f"there is no function {function}")
        return re.sub(r"\s+", " ", re.sub(r"/\*.*?\*/", "", found.group(1) or found.group(2), flags=re.S))

    def demand(self, function, fragment):
        require(fragment in self.body(function), f"{function} no longer contains `{fragment}`: redo the proof")

    def number(self, function, pattern):
        """The number that the group of `pattern` finds in a function."""
        found = re.search(pattern, self.body(function))
        require(found, f"{function} no longer contains /{pattern}/: redo the proof")
        text = found.group(1)
        return float.fromhex(text) if text.startswith(("0x", "-0x")) else float(text)
