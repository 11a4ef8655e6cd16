"""Valid entries of all kinds together, at random: twelve of the many scenes of
validation/stability/scenes.py."""

import pytest

from randomScenes import judge, made


@pytest.mark.parametrize("seed", range(12))
def testScene(tmp_path, figures, seed):
    figures.equal(made(seed)[1], judge(seed, tmp_path), [])
