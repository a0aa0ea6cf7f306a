// Any scene file yields a scene or an error message.
#include "test/formats/pbrt/parse.h"
#include "test/sanitized.h"
#include <gtest/gtest.h>
#include <random>
#include <string>

#include "montelux/mc/math/overloaded.h"

namespace montelux {
namespace {

const std::string scene = R"(# A scene with something of everything.
Option "integer seed" 3
Integrator "path" "integer maxdepth" [ 8 ]
LookAt 1 2 3 0 0 0 0 1 0
Film "rgb" "integer xresolution" [ 40 ] "integer yresolution" [ 30 ] "float cropwindow" [ 0 1 0 .5 ]
Camera "perspective" "float fov" [ 38 ] "float screenwindow" [ -1 1 -1 1 ]
Sampler "halton" "integer pixelsamples" 4
PixelFilter "triangle" "float xradius" 1
WorldBegin
LightSource "distant" "blackbody L" 5000 "point3 from" [ 0 1 0 ]
Texture "grid" "spectrum" "checkerboard" "rgb tex1" [ 1 .5 .25 ] "float uscale" 20
Texture "s" "float" "scale" "float scale" 0.5 "float tex" 2
MakeNamedMaterial "metal" "string type" "conductor" "spectrum eta" "metal-Ag-eta" "texture roughness" "s"
ObjectBegin "o" NamedMaterial "metal" Shape "disk" "float height" 1 ObjectEnd
AttributeBegin
  AreaLightSource "diffuse" "rgb L" [ 17 12 4 ] "bool twosided" true
  Rotate 30 0 0 1 Scale 1 2 1 ReverseOrientation
  Shape "trianglemesh" "point3 P" [ 0 0 0 1 0 0 0 1 0 1 1 .5 ] "integer indices" [ 0 1 2 2 1 3 ]
AttributeEnd
Material "coateddiffuse" "texture reflectance" "grid" "spectrum albedo" [ 400 .1 700 .2 ]
Shape "loopsubdiv" "integer levels" 1 "point3 P" [ 0 0 0 1 0 0 0 1 0 0 0 1 ] "integer indices" [ 0 2 1 0 1 3 1 2 3 2 0 3 ]
Shape "bilinearmesh" "point3 P" [ 0 0 0 1 0 0 0 1 0 1 1 1 ] "integer indices" [ 0 1 2 3 ] "point2 uv" [ 0 0 1 0 0 1 1 1 ]
Shape "curve" "string type" "ribbon" "string basis" "bspline" "integer degree" 2 "point3 P" [ 0 0 0 1 0 0 0 1 0 1 1 1 ] "normal N" [ 0 0 1 0 1 1 1 0 1 ] "float width" 0.1
ObjectInstance "o" ConcatTransform [ 1 0 0 0 0 1 0 0 0 0 1 0 1 2 3 1 ] ObjectInstance "o"
)";

// Only Errors may be thrown, and an accepted scene contains no dangling reference.
void expect_sound(const std::string& text) {
    SceneDescription d;
    try {
        d = test::parse(text);
    } catch (const Error& e) {
        ASSERT_EQ(std::string(e.what()).substr(0, 6), "scene:") << e.what();
        return;
    }
    ASSERT_GT(d.film.width, 0);
    ASSERT_GT(d.sampler.spp, 0u);
    for (const Shape& s : d.scene.shapes) {
        ASSERT_LT(s.material, d.scene.materials.size());
        ASSERT_TRUE(std::visit(
            Overloaded{[&](MeshIndex i) { return i.index < d.scene.meshes.size(); },
                       [&](QuadricIndex i) { return i.index < d.scene.quadrics.size(); },
                       [&](CurvesIndex i) { return i.index < d.scene.curves.size(); },
                       [&](BilinearMeshIndex i) { return i.index < d.scene.bilinear_meshes.size(); }},
            s.geometry));
        ASSERT_TRUE(s.light == no_index || s.light < d.scene.lights.size());
    }
    for (const TriangleMesh& m : d.scene.meshes)
        for (Index i : m.indices) ASSERT_LT(i, m.positions.size());
    for (const BilinearMesh& m : d.scene.bilinear_meshes)
        for (Index i : m.indices) ASSERT_LT(i, m.positions.size());
    for (const Instance& i : d.scene.instances) ASSERT_LT(i.object, d.scene.objects.size());
}

TEST(PbrtMutations, TheSceneItselfIsRight) {
    SceneDescription d = test::parse(scene);
    EXPECT_EQ(d.scene.lights.size(), 2u);
    EXPECT_EQ(d.scene.instances.size(), 2u);
}

TEST(PbrtMutations, Bytes) {
    std::mt19937 random(5);
    for (int n = 0; n < (under_sanitizers ? 3000 : 10000); ++n) {
        std::string text = scene;
        for (unsigned k = 0; k <= random() % 3; ++k) {
            std::size_t at = random() % text.size();
            switch (random() % 4) {
            case 0:
                text[at] = static_cast<char>(random());
                break;
            case 1:
                text.erase(at, random() % 5);
                break;
            case 2:
                text.insert(at, 1, "0123456789-.e[]\"# \n\\"[random() % 20]);
                break;
            default:
                text[at] = scene[random() % scene.size()];
            }
        }
        expect_sound(text);
        if (HasFatalFailure()) FAIL() << text;
    }
}

TEST(PbrtMutations, Words) {
    std::vector<std::string> words;
    for (std::size_t i = 0; i < scene.size();) {
        std::size_t end = std::min(scene.find_first_of(" \n", i), scene.size());
        words.push_back(scene.substr(i, end - i) +
                        (scene[std::min(end, scene.size() - 1)] == '\n' ? "\n" : " "));
        i = end + 1;
    }
    std::mt19937 random(6);
    const std::string odd[] = {"-1 ",    "0 ",    "1e38 ", "-1e38 ", "2147483647 ",
                               "1e-45 ", "\"\" ", "[ ] ",  "99999 ", "x "};
    for (int n = 0; n < (under_sanitizers ? 3000 : 10000); ++n) {
        std::vector<std::string> changed = words;
        for (unsigned k = 0; k <= random() % 2; ++k) {
            std::size_t at = random() % changed.size();
            switch (random() % 4) {
            case 0:
                changed.erase(changed.begin() + static_cast<std::ptrdiff_t>(at));
                break;
            case 1:
                changed[at] = odd[random() % std::size(odd)];
                break;
            case 2:
                std::swap(changed[at], changed[random() % changed.size()]);
                break;
            default:
                changed.insert(changed.begin() + static_cast<std::ptrdiff_t>(at),
                               words[random() % words.size()]);
            }
        }
        std::string text;
        for (const std::string& w : changed) text += w;
        expect_sound(text);
        if (HasFatalFailure()) FAIL() << text;
    }
}

TEST(PbrtMutations, EveryTruncation) {
    for (std::size_t n = 0; n < scene.size(); ++n) expect_sound(scene.substr(0, n));
}

} // namespace
} // namespace montelux
