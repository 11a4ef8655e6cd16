"""The benchmark runs and reports; how fast it was is judged nowhere."""

import json
import subprocess
from pathlib import Path

RUN = Path(__file__).resolve().parent / "run"


def testRunsAndReports(tmp_path):
    result = subprocess.run(
        [RUN, "--quick", "--json", tmp_path / "benchmark.json"],
        capture_output=True, text=True, timeout=600,
    )
    assert result.returncode == 0, result.stdout + result.stderr
    assert "ns CPU per point and step" in result.stdout

    figures = json.loads((tmp_path / "benchmark.json").read_text())
    run = figures["configurations"]["2D9"]
    assert run["points"] > 4000
    assert run["ns"] > 0 and run["nsPlain"] > 0 and run["bytesPerPoint"] > 0
    assert figures["twoRanks"]["2D9"]["speedUp"] > 0


def testPlainKernelMovesTheSameWater(tmp_path):
    """Else the ratio to it would mean nothing."""
    result = subprocess.run(
        [RUN, "--quick", "--no-ranks", "--json", tmp_path / "benchmark.json", "2D16", "3D8"],
        capture_output=True, text=True, timeout=600,
    )
    assert result.returncode == 0, result.stdout + result.stderr

    figures = json.loads((tmp_path / "benchmark.json").read_text())
    for run in figures["configurations"].values():
        assert run["plainCentreDistance"] < 0.01     # cells


def testMeasuresSoil(tmp_path):
    result = subprocess.run(
        [RUN, "--quick", "--no-ranks", "--json", tmp_path / "benchmark.json", "soilRest", "soilFlow"],
        capture_output=True, text=True, timeout=600,
    )
    assert result.returncode == 0, result.stdout + result.stderr

    figures = json.loads((tmp_path / "benchmark.json").read_text())
    rest, flow = (figures["configurations"][n] for n in ["soilRest", "soilFlow"])
    assert rest["points"] > 4000 and flow["points"] > 1000
    assert 0 < rest["ns"] and 0 < flow["ns"]
