"""Models by themselves, and the studio."""

import montelux
import pytest


@pytest.fixture
def tent(tmp_path):
    path = tmp_path / "tent.obj"
    path.write_text("v -1 0 -1\nv 1 0 -1\nv 1 0 1\nv 0 2 0\nf 1 2 3\nf 1 4 2\nf 2 4 3\nf 3 4 1\n")
    return path


def test_a_model_gets_a_studio(tent):
    scene = montelux.load(tent)
    assert scene.camera is not None
    assert len(scene.lights) == 1
    assert len(scene.shapes) == 2
    scene.film.resolution = 16, 12
    assert scene.render(spp=4).mean.mean() > 0.1


def test_options_change_it(tent):
    assert len(montelux.load(tent, ground=False).shapes) == 1
    assert len(montelux.load(tent, environment="none").lights) == 0
    scene = montelux.load(tent, ground=False, orbit=(90, 0, 2), background=(0.25, 0.5, 3))
    scene.film.resolution = 16, 12
    assert scene.render(spp=4).mean[0, 0].tolist() == pytest.approx([0.25, 0.5, 3])


def test_mistakes_are_sentences(tent, tmp_path):
    for name, value, sentence in [
        ("orbit", (1, 2, 3, 4), "montelux.load, orbit: '1.0,2.0,3.0,4.0' was given; expected AZ,EL"),
        ("orbit", 5, "montelux.load, orbit: 5 was given; expected numbers"),
        ("orbit", (0, 100), "montelux.load, orbit: '0.0,100.0' was given"),
        ("background", "redish", "montelux.load, background: 'redish' was given; expected transparent, black"),
        ("background", (1, -1, 0), "montelux.load, background: "),
        ("environment", tmp_path / "none.exr", "none.exr"),
    ]:
        with pytest.raises(montelux.Error, match=sentence):
            montelux.load(tent, **{name: value})
