"""Why a pixel has a plane or none."""

from __future__ import annotations

from typing import Any

from ._words import in_python


class Explanation:
    """Why a pixel has a plane or none: what each stage of the method saw there, and what to change."""

    def __init__(self, record: dict[str, Any]) -> None:
        self._record = record

    @property
    def verdict(self) -> str:
        """``"plane"``, or why there is none: ``"not_measured"``, ``"small"``, ``"curved"``, ``"uneven"``, ``"off"`` and others."""
        return str(self._record["verdict"]["kind"])

    @property
    def text(self) -> str:
        """The verdict as a sentence."""
        return in_python(str(self._record["verdict"]["text"]))

    @property
    def findings(self) -> list[dict[str, Any]]:
        """What each stage saw, in order."""
        return list(self._record["findings"])

    @property
    def suggestions(self) -> list[dict[str, float]]:
        """Parameters, each set tried, under which the pixel has a plane: keywords of `Detector`."""
        return [
            {name.replace("-", "_"): value for name, value in suggestion["parameters"].items()}
            for suggestion in self._record["suggestions"]
        ]

    def to_dict(self) -> dict[str, Any]:
        """The record, as ``depthplanes explain --json`` writes it (docs/explain.md)."""
        return self._record

    def __str__(self) -> str:
        tries = [", ".join(f"{name}={value:g}" for name, value in one.items()) for one in self.suggestions]
        return self.text + "".join(f"\nTry {one}." for one in tries)

    def __repr__(self) -> str:
        return f"<Explanation: {self.text}>"
