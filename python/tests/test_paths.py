"""Looking into pictures: strategies, chains of paths, and guides."""

from __future__ import annotations

import numpy as np
import pytest

import montelux
from montelux.lab.light import luminance
from montelux.lab.light import scene as lab_scene


def small(name: str, method: str) -> montelux.Scene:
    """A scene of the lab, with few pixels."""
    scene = lab_scene(name)
    scene.film.resolution = 24, 18
    scene.integrator.method = method
    scene.integrator.max_depth = 3
    return scene


def test_pictures_of_strategies_add_up_to_the_render():
    scene = small("shades", "bidirectional")
    pictures = scene.strategy_pictures(spp=16, seed=5)
    render = scene.render(spp=16, seed=5)
    total = np.sum([p.weighted for p in pictures], axis=0)
    assert total.shape == render.mean.shape
    assert np.allclose(total, render.mean, rtol=1e-4, atol=1e-6)
    ways = [(p.s, p.t) for p in pictures]
    assert ways == sorted(ways, key=lambda way: (sum(way), way[0])) and {(0, 3), (1, 2), (2, 1), (3, 2)} <= set(ways)
    # Weights are at most 1; samples of single wavelengths may be negative in R, G or B.
    assert all(np.all(luminance(p.weighted) <= luminance(p.unweighted) * (1 + 1e-4) + 1e-6) for p in pictures)
    assert "s = 0, t = 3, 24 x 18 pixels" in repr(pictures[0])
    again = scene.strategy_pictures(spp=16, seed=5, threads=3)
    assert all(np.array_equal(a.weighted, b.weighted) for a, b in zip(pictures, again))


def test_strategies_need_a_method_that_has_them():
    scene = small("shades", "path")
    with pytest.raises(montelux.Error, match="the integrator 'path' has none; choose 'bidirectional'"):
        scene.strategy_pictures(spp=1)
    scene.integrator.method = "bidirectional"
    scene.integrator.max_depth = 13
    with pytest.raises(montelux.Error, match="max_depth is 13; expected at most 12"):
        scene.strategy_pictures(spp=1)
    with pytest.raises(montelux.Error, match="strategy_pictures: spp=0 was given"):
        scene.strategy_pictures(spp=0)
    scene.integrator.max_depth = 1
    with pytest.raises(AttributeError, match="did you mean 'weighted'"):
        scene.strategy_pictures(spp=1)[0].weigthed  # noqa: B018


def test_chains_walk_from_accepted_state_to_accepted_state():
    scene = small("shades", "metropolis")
    walks = scene.path_chains(chains=3, spp=1024, seed=2)
    chains, steps = walks.accepted.shape
    assert chains == 3 and walks.film.shape == (3, steps + 1, 2) and walks.proposed.shape == (3, steps, 2)
    stayed = ~walks.accepted
    assert np.array_equal(walks.film[:, 1:][walks.accepted], walks.proposed[walks.accepted])
    assert np.array_equal(walks.film[:, 1:][stayed], walks.film[:, :-1][stayed])
    assert np.array_equal(walks.size[:, 1:][walks.accepted], walks.proposed_size[walks.accepted])
    assert np.allclose(walks.acceptance, np.minimum(1, walks.proposed_size / walks.size[:, :-1]))
    assert 0 < walks.large.mean() < 1 and "3 chains" in repr(walks)
    small_moves = np.linalg.norm(walks.proposed - walks.film[:, :-1], axis=-1)[~walks.large]
    assert np.median(small_moves) < 6  # pixels
    other = scene.path_chains(chains=2, group=1, spp=1024, seed=2)
    assert not np.array_equal(other.proposed[0], walks.proposed[0])


def test_chains_are_those_of_metropolis():
    with pytest.raises(montelux.Error, match="only the integrator 'metropolis' has chains"):
        small("shades", "path").path_chains()
    scene = small("shades", "metropolis")
    for wrong in ({"chains": 0}, {"group": -1}, {"spp": 0}, {"threads": -1}):
        with pytest.raises(montelux.Error, match=f"path_chains: {next(iter(wrong))}="):
            scene.path_chains(**wrong)
    scene.integrator.max_depth = 1  # chains follow light of two events and more
    assert scene.path_chains(spp=64).accepted.shape == (0, 0)


@pytest.fixture(scope="module")
def guide() -> montelux.Guide:
    scene = small("doorway", "path")
    scene.integrator.max_depth = 6
    assert scene.render(spp=4).guide is None
    scene.integrator.guiding = "on"
    found = scene.render(spp=384, seed=4).guide
    assert found is not None
    return found


def test_a_guide_has_densities_where_paths_were(guide):
    directions = montelux.warp.equal_area_sphere.sample(montelux.points("independent", 1 << 14, 2, seed=3))
    p = guide.pdf((1.5, 0, 1), (0, 1, 0), directions)
    assert p.shape == (1 << 14,) and abs(4 * np.pi * p.mean() - 1) < 6 * 4 * np.pi * p.std() / 128
    assert guide.pdf((1.5, 0, 1), (0, 2, 0), directions[:6].reshape(2, 3, 3)).shape == (2, 3)
    assert np.array_equal(guide.pdf((1.5, 0, 1), (0, 2, 0), 5 * directions[:9]), p[:9])
    assert 0 < guide.share((1.5, 0, 1), (0, 1, 0)) < 1
    # No path has been in a medium.
    assert not guide.pdf((1.5, 0, 1), None, directions).any() and guide.share((1.5, 0, 1), None) == 0


def test_cells_cover_space(guide):
    sides, bounds = guide.cells()
    assert bounds.shape == (guide.regions, 2, 3) and guide.bytes > 1000
    assert set(sides) == {"-x", "+x", "-y", "+y", "-z", "+z"}
    for side in set(sides):
        mine = bounds[[s == side for s in sides]]
        for point in np.random.default_rng(1).uniform(-2, 2, (50, 3)):
            assert np.all((mine[:, 0] <= point) & (point < mine[:, 1]), axis=1).sum() == 1


def test_mistakes_with_a_guide(guide):
    for arguments, reason in (
        (((0, 0), (0, 1, 0), [(0, 1, 0)]), "Guide.pdf, point: expected three numbers"),
        (((0, 0, float("nan")), (0, 1, 0), [(0, 1, 0)]), "Guide.pdf, point: expected three finite numbers"),
        (((0, 0, 0), (0, 0, 0), [(0, 1, 0)]), "Guide.pdf, normal: expected a vector other than zero"),
        (((0, 0, 0), (0, 1, 0), [(0, 0, 0)]), "Guide.pdf, directions: expected directions"),
    ):
        with pytest.raises(montelux.Error, match=reason):
            guide.pdf(*arguments)
