"""Models by themselves, glTF scenes, and the studio."""

import base64
import json
import struct

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


@pytest.fixture
def gltf(tmp_path):
    """A triangle that moves by 1 along x within a second, and two cameras."""
    triangle = struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0)
    motion = struct.pack("<2f", 0, 1) + struct.pack("<6f", 0, 0, 0, 1, 0, 0)
    uri = "data:application/octet-stream;base64," + base64.b64encode(triangle + motion).decode()
    perspective = {"type": "perspective", "perspective": {"yfov": 0.8, "znear": 0.1}}
    scene = {
        "asset": {"version": "2.0"},
        "buffers": [{"byteLength": 68, "uri": uri}],
        "bufferViews": [
            {"buffer": 0, "byteLength": 36},
            {"buffer": 0, "byteOffset": 36, "byteLength": 8},
            {"buffer": 0, "byteOffset": 44, "byteLength": 24},
        ],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]},
            {"bufferView": 1, "componentType": 5126, "count": 2, "type": "SCALAR", "min": [0], "max": [1]},
            {"bufferView": 2, "componentType": 5126, "count": 2, "type": "VEC3"},
        ],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "cameras": [perspective, perspective],
        "nodes": [
            {"mesh": 0},
            {"camera": 0, "translation": [0, 0, 5], "name": "near"},
            {"camera": 1, "translation": [0, 0, 9], "name": "far"},
        ],
        "scenes": [{"nodes": [0, 1, 2]}],
        "scene": 0,
        "animations": [
            {
                "samplers": [{"input": 1, "output": 2}],
                "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}],
            }
        ],
    }
    path = tmp_path / "scene.gltf"
    path.write_text(json.dumps(scene))
    return path


def test_gltf_scenes_have_cameras_and_a_time(gltf):
    assert montelux.load(gltf).camera.world_from_camera[:3, 3] == pytest.approx([0, 0, 5])
    assert montelux.load(gltf, camera="far").camera.world_from_camera[:3, 3] == pytest.approx([0, 0, 9])
    assert montelux.load(gltf, camera=1).camera.world_from_camera[:3, 3] == pytest.approx([0, 0, 9])
    rest, later = montelux.load(gltf), montelux.load(gltf, time=1)
    depth = []
    for scene in rest, later:
        scene.film.resolution = 16, 12
        depth.append(scene.render(spp=4).layers["depth"])
    assert (depth[0] != depth[1]).any()
    blurred = montelux.load(gltf, time=0.5, shutter=1)
    blurred.film.resolution = 16, 12
    assert (blurred.render(spp=4).layers["depth"] != depth[1]).any()
    with pytest.raises(montelux.Error, match="shutter: expected a time of the animations, when it opens"):
        montelux.load(gltf, shutter=1)
    with pytest.raises(montelux.Error, match="shutter: expected a number of seconds that is not negative"):
        montelux.load(gltf, time=1, shutter=-1)
    with pytest.raises(montelux.Error, match="there is no camera 'fra'"):
        montelux.load(gltf, camera="fra")
    with pytest.raises(montelux.Error, match="variant"):
        montelux.load(gltf, variant="red")


def test_mitsuba_scenes_have_parameters(tmp_path):
    path = tmp_path / "scene.xml"
    path.write_text(
        '<scene version="3.0.0"><default name="grey" value="0.5"/><default name="hidden" value="false"/>'
        '<sensor type="perspective" id="near"><film type="hdrfilm"><integer name="width" value="12"/>'
        '<integer name="height" value="8"/></film><transform name="to_world">'
        '<lookat origin="0 0 5" target="0 0 0" up="0 1 0"/></transform></sensor><emitter type="constant"/>'
        '<integrator type="path"><boolean name="hide_emitters" value="$hidden"/></integrator>'
        '<shape type="sphere"><bsdf type="diffuse"><float name="reflectance" value="$grey"/></bsdf></shape></scene>'
    )

    def middle(scene):
        return scene.render(spp=4).mean[4, 6, 0]

    assert middle(montelux.load(path, definitions={"grey": 0.25})) < middle(montelux.load(path))
    assert montelux.load(path, camera="near").film.resolution == (12, 8)
    with pytest.warns(UserWarning, match="hide_emitters"):
        montelux.load(path, definitions={"hidden": True})
    with pytest.raises(montelux.Error, match="'reflectance' is 'dark'; expected a number"):
        montelux.load(path, definitions={"grey": "dark"})
    with pytest.raises(montelux.Error, match="scene.xml:1:"):
        montelux.load(path, definitions={"hidden": 3})
