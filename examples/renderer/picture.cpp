// A grey sphere under a white sky: each of its points sees only sky and reflects its albedo, 0.5.
#include <exception>
#include <iostream>
#include <montelux/film/film.h>
#include <montelux/formats/pbrt/load_pbrt.h>
#include <montelux/image/image_write.h>
#include <montelux/mc/stats/estimate.h>
#include <montelux/render/renderer.h>

constexpr std::string_view scene = R"(
    Film "rgb" "integer xresolution" 64 "integer yresolution" 64
    Sampler "independent" "integer pixelsamples" 256
    LookAt 0 -4 0  0 0 0  0 0 1
    Camera "perspective" "float fov" 40
    WorldBegin
    LightSource "infinite" "rgb L" [ 1 1 1 ]
    Material "diffuse" "rgb reflectance" [ 0.5 0.5 0.5 ]
    Shape "sphere")";

int main() try {
    montelux::Warnings warnings;
    const montelux::SceneDescription description =
        montelux::parse_pbrt(scene, "sphere under the sky", ".", warnings);
    for (const std::string& warning : warnings.messages()) std::cerr << warning << "\n";

    montelux::Film film(description.film);
    montelux::Renderer(description).render(film);
    montelux::write_image("sphere.exr", film.develop());

    const auto& green = film.pixel(32, 32).replicates();
    const montelux::Estimate middle{green.mean(1), green.standard_error(1), green.count()};
    std::cout << "green in the middle of sphere.exr = " << middle << "\n";
} catch (const std::exception& e) {
    std::cerr << e.what() << "\n";
    return 1;
}
