"""The benchmark of the constitutive models runs, on points of the kinds that it
names; how fast it was is judged nowhere."""

import subprocess


def testRunsAndReports():
    result = subprocess.run(["mpmConstitutiveBenchmark", "512", "3"],
                            capture_output=True, text=True, timeout=60)
    assert result.returncode == 0, result.stderr
    print(result.stdout)
    rows = [line.split() for line in result.stdout.splitlines()
            if line.endswith("%")]
    assert [row[0] for row in rows] == 2*(
        4*["plastic"] + ["elastic", "suspended", "separated"])
    for row in rows:
        assert float(row[3]) > 0
        # Some of the largest increments open the point instead
        assert float(row[-2]) > 85, row
