"""Dictionaries of OpenFOAM as Python dictionaries, and errors that name the
file, the entry, the value found and the values allowed."""

import re
import subprocess

from .foamFile import FoamFileError

_TOKEN = re.compile(r"""
    \s+ | //[^\n]* | /\*.*?\*/                  # nothing
  | "(?P<string>(?:[^"\\]|\\.)*)"
  | (?P<dimensions>\[[^\]]*\])
  | (?P<bracket>[{}();])
  | (?P<word>(?:[^\s{}();"\[\]]|\([^\s(){};"]*\))+)
""", re.VERBOSE | re.DOTALL)

_NUMBER = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?")

_REQUIRED = object()


def number(token):
    """A token as a number, or None"""
    if isinstance(token, (int, float)):
        return token
    if isinstance(token, str) and _NUMBER.fullmatch(token):
        return float(token)
    return None


def _tokens(text, path):
    pos = 0
    while pos < len(text):
        found = _TOKEN.match(text, pos)
        # "name(": a word never swallows a bracket that opens a list
        if not found:
            raise FoamFileError(
                f"{path}: not readable at '{text[pos:pos+20]}'")
        pos = found.end()
        kind = found.lastgroup
        if kind:
            yield kind, found[kind]


class _Parser:
    def __init__(self, text, path):
        self.tokens = list(_tokens(text, path))
        self.path = path
        self.pos = 0

    def next(self):
        if self.pos == len(self.tokens):
            raise FoamFileError(
                f"{self.path}: ends within a dictionary or list")
        self.pos += 1
        return self.tokens[self.pos - 1]

    def dictionary(self, top=False):
        entries = {}
        while True:
            if top and self.pos == len(self.tokens):
                return entries
            kind, token = self.next()
            if (kind, token) == ("bracket", "}"):
                return entries
            if (kind, token) == ("bracket", ";"):
                continue
            if kind == "bracket":
                # A list without a name, as in constant/polyMesh/boundary
                if token == "(":
                    entries.setdefault("", []).append(self.list())
                    continue
                raise FoamFileError(f"{self.path}: unexpected '{token}'")
            value = []
            while True:
                kind, item = self.next()
                if (kind, item) == ("bracket", ";"):
                    break
                if (kind, item) == ("bracket", "{"):
                    inner = self.dictionary()
                    if not value:
                        value = inner
                        break
                    value.append(inner)
                elif (kind, item) == ("bracket", "("):
                    value.append(self.list())
                    # constant/polyMesh/boundary: "5 ( ... )" without ";"
                    if top and number(token) is not None:
                        break
                elif kind == "bracket":
                    raise FoamFileError(
                        f"{self.path}: entry {token}: unexpected '{item}'")
                else:
                    value.append(item)
            if isinstance(value, list) and len(value) == 1:
                value = value[0]
            # As OpenFOAM does: a dictionary given twice is merged
            if isinstance(value, dict) and isinstance(
                    entries.get(token), dict):
                entries[token].update(value)
            else:
                entries[token] = value

    def list(self):
        items = []
        while True:
            kind, token = self.next()
            if (kind, token) == ("bracket", ")"):
                return items
            if (kind, token) == ("bracket", "("):
                items.append(self.list())
            elif (kind, token) == ("bracket", "{"):
                items.append(self.dictionary())
            elif kind == "bracket":
                raise FoamFileError(f"{self.path}: unexpected '{token}'")
            else:
                items.append(token)


def parse(text, path="text"):
    """A dictionary without macros: name -> str, list or dict; a value of
    several tokens is a list of them. Numbers stay strings (see number)."""
    return _Parser(text, path).dictionary(top=True)


def read(path, entry=None):
    """A file, with its macros and includes expanded by foamDictionary"""
    command = ["foamDictionary", str(path)]
    command += ["-entry", entry, "-value"] if entry else ["-expand"]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode:
        reason = done.stderr.strip() or done.stdout.strip()
        raise FoamFileError(f"{path}: foamDictionary cannot read it:\n{reason}")
    text = done.stdout
    if entry:
        text = text.strip()
        text = text[1:-1] if text.startswith("{") else text
    return parse(text, path)


class Dictionary:
    """Entries with checks. path and scope say in errors where they are."""

    def __init__(self, entries, path, scope=""):
        self.entries, self.path, self.scope = entries, path, scope

    @classmethod
    def read(cls, path):
        entries = read(path)
        entries.pop("FoamFile", None)
        return cls(entries, path)

    def __contains__(self, key):
        return key in self.entries

    def __iter__(self):
        return iter(self.entries)

    def name(self, key=None):
        return "/".join(n for n in [self.scope, key] if n)

    def fail(self, key, allowed):
        found = self.entries.get(key)
        what = "is missing" if found is None else \
            f"has the value {text(found)}"
        raise FoamFileError(
            f"{self.path}: entry {self.name(key)} {what}.\n"
            f"    Allowed: {allowed}")

    def checkKeywords(self, known):
        for key in self.entries:
            if key not in known:
                raise FoamFileError(
                    f"{self.path}: unknown entry {self.name(key)}.\n"
                    f"    Allowed: {', '.join(known)}")

    def number(self, key, default=_REQUIRED, allowed="a number",
               within=lambda v: True):
        if key not in self.entries and default is not _REQUIRED:
            return default
        value = number(self.entries.get(key))
        if value is None or not within(value):
            self.fail(key, allowed)
        return value

    def word(self, key, default=_REQUIRED, choices=None, allowed="a word"):
        if key not in self.entries and default is not _REQUIRED:
            return default
        value = self.entries.get(key)
        if not isinstance(value, str) or (choices and value not in choices):
            self.fail(key, ", ".join(choices) if choices else allowed)
        return value

    def flag(self, key, default=_REQUIRED):
        value = self.word(key, default if default is _REQUIRED else
                          ("yes" if default else "no"),
                          choices=["yes", "no", "true", "false", "on", "off"])
        return value in ("yes", "true", "on")

    def sub(self, key, required=True):
        """A dictionary; an empty one if it may be missing"""
        if key not in self.entries and not required:
            return Dictionary({}, self.path, self.name(key))
        if not isinstance(self.entries.get(key), dict):
            self.fail(key, "a dictionary { ... }")
        return Dictionary(self.entries[key], self.path, self.name(key))


def text(value):
    """A value as OpenFOAM writes it"""
    if isinstance(value, dict):
        return "{ " + " ".join(f"{k} {text(v)}" + (
            "" if isinstance(v, dict) else ";")
            for k, v in value.items()) + " }"
    if isinstance(value, (list, tuple)):
        return "(" + " ".join(map(text, value)) + ")"
    if isinstance(value, float):
        return f"{value:.10g}"
    return str(value)


HEADER = """FoamFile
{{
    version     2.0;
    format      ascii;
    class       {kind};
    object      {name};
}}
"""


def header(name, kind="dictionary"):
    return HEADER.format(name=name, kind=kind)
