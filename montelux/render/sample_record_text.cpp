#include "montelux/render/sample_record_text.h"

#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <optional>
#include <type_traits>

#include "montelux/mc/math/overloaded.h"
#include "montelux/scene/material/make_bsdf.h"
#include "montelux/scene/setting_names.h"

namespace montelux {

namespace {

// Lines of a label and a text, in columns.
class Text {
  public:
    std::string take() { return std::move(text_); }

    [[gnu::format(printf, 2, 3)]] Text& add(const char* format, ...) {
        char buffer[512];
        va_list arguments;
        va_start(arguments, format);
        std::vsnprintf(buffer, sizeof buffer, format, arguments);
        va_end(arguments);
        text_ += buffer;
        return *this;
    }
    Text& label(int level, const char* name) {
        const int indent = 2 * level;
        return add("%*s%-*s", indent, "", 22 - indent, name);
    }
    Text& end() {
        text_ += '\n';
        return *this;
    }
    // The sign of "nan" is meaningless.
    Text& number(float v, int width = 0) {
        return std::isnan(v) ? add("%*s", width, "nan") : add("%*.7g", width, static_cast<double>(v));
    }
    Text& vector(Vec3f v) {
        return add("(").number(v.x).add(", ").number(v.y).add(", ").number(v.z).add(")");
    }
    Text& columns(int level, const char* name, SampledSpectrum s) {
        label(level, name);
        for (int i = 0; i < spectrum_samples; ++i) number(s[i], 15);
        return end();
    }
    Text& rgb(int level, const char* name, Vec3f v) {
        label(level, name);
        return number(v.x, 15).number(v.y, 15).number(v.z, 15).end();
    }

  private:
    std::string text_;
};

void add_light(Text& t, const char* how, Index index, Index part, const Scene& scene) {
    const Light& light = scene.lights[index];
    t.add("  %s light %u, %s", how, static_cast<unsigned>(index), name_of(light).data());
    if (const auto* area = std::get_if<AreaLight>(&light))
        t.add(" of shape %u, primitive %u", static_cast<unsigned>(area->shape), static_cast<unsigned>(part));
}

// A field of a BSDF that fits into the line of its name.
void add_inline(Text& t, const char* name, float value) { t.add(", %s ", name).number(value); }
void add_inline(Text& t, const char* name, const Ggx& ggx) {
    if (ggx.is_smooth())
        t.add(", %s smooth", name);
    else
        t.add(", %s GGX alpha ", name).number(ggx.alpha_x).add(" x ").number(ggx.alpha_y);
}
void add_inline(Text& t, const char* name, const MicrofacetNormals& normals) {
    if (normals.is_smooth())
        t.add(", %s smooth", name);
    else
        t.add(", %s %s alpha ", name, name_of(normals.distribution).data())
            .number(normals.alpha_x)
            .add(" x ")
            .number(normals.alpha_y);
}

// The kind of the BSDF, and its parameters at the vertex.
void add_bsdf(Text& t, const BsdfModel auto& bsdf) {
    t.add("%s", bsdf.name);
    bsdf.visit_fields([&](const char* name, const auto& field) {
        if constexpr (requires { add_inline(t, name, field); }) add_inline(t, name, field);
    });
    t.end();
    bsdf.visit_fields([&]<typename F>(const char* name, const F& field) {
        if constexpr (std::is_same_v<F, SampledSpectrum>) {
            t.columns(2, name, field);
        } else if constexpr (BsdfModel<F>) {
            t.label(2, name);
            add_bsdf(t, field);
        } else {
            static_assert(requires { add_inline(t, name, field); });
        }
    });
}

void add_densities(Text& t, float light_pdf, float bsdf_pdf, float weight) {
    t.label(2, "densities").add("light ").number(light_pdf).add(", BSDF ").number(bsdf_pdf);
    t.add(" per steradian; weight ").number(weight).end();
}

// In media three strategies may find the same light.
void add_densities_of_three(Text& t, const DirectLight& direct, bool on_ray) {
    t.label(2, "densities").add(on_ray ? "equiangular " : "light ").number(direct.light_pdf);
    t.add(on_ray ? ", free flight with light " : ", equiangular ").number(direct.other_pdf);
    t.add(on_ray ? ", with phase function " : ", phase function ").number(direct.bsdf_pdf);
    t.add("; weight ").number(direct.weight).end();
}

void add_found(Text& t, const FoundLight& found, const Scene& scene) {
    add_light(t, "met", found.light, found.part, scene);
    t.end();
    t.columns(2, "radiance", found.radiance);
    if (found.shared)
        add_densities(t, found.light_pdf, found.bsdf_pdf, found.weight);
    else
        t.label(2, "weight").add("1: nothing else could have found it").end();
    if (found.counted)
        t.columns(2, "contribution", found.contribution);
    else
        t.label(2, "contribution").add("to the term mis-bsdf, which is left out").end();
}

// `distance`: along the ray, of a light that was sampled from a point on it.
void add_direct(Text& t, const DirectLight& direct, const Scene& scene,
                std::optional<float> distance = std::nullopt) {
    using Outcome = DirectLight::Outcome;
    add_light(t, distance ? "sampled on the way" : "sampled", direct.light, direct.part, scene);
    t.add(", chosen with probability ").number(direct.choice);
    if (distance) t.add(", from the distance ").number(*distance);
    switch (direct.outcome) {
    case Outcome::counted:
    case Outcome::other_term:
        t.end();
        break;
    case Outcome::occluded:
        t.add(": occluded").end();
        break;
    case Outcome::dark:
        t.add(": it cannot shine here").end();
        return;
    case Outcome::left_to_scattering:
        t.add(": left to scattering by the strategy").end();
        return;
    case Outcome::no_transport:
        t.add(": no light goes this way").end();
        break;
    }
    t.label(2, "direction").vector(direct.wi);
    if (std::isfinite(direct.shadow.t_max)) t.add(", distance ").number(length(direct.shadow.d));
    t.end();
    t.columns(2, direct.delta ? "irradiance" : "radiance", direct.radiance);
    t.columns(2, distance ? "scattering" : "BSDF x cosine", direct.f);
    if (direct.outcome == Outcome::no_transport) return;
    if (distance || direct.other_pdf > 0)
        add_densities_of_three(t, direct, distance.has_value());
    else if (direct.delta)
        t.label(2, "weight").add("1: nothing else could have found it").end();
    else
        add_densities(t, direct.light_pdf, direct.bsdf_pdf, direct.weight);
    if (direct.outcome == Outcome::counted) t.columns(2, "contribution", direct.contribution);
    if (direct.outcome == Outcome::other_term)
        t.label(2, "contribution").add("to the term mis-light, which is left out").end();
}

void add_roulette(Text& t, const PathVertex& v) {
    if (!v.roulette) return;
    const bool survived = v.roulette->u < v.roulette->survival;
    t.label(1, "roulette").add("survives below ").number(v.roulette->survival);
    t.add("; drew ").number(v.roulette->u).add(survived ? ": survived" : ": ended").end();
}

void add_scattering(Text& t, const PathVertex& v) {
    const BsdfSample& s = v.scattering->sample;
    t.add("  continued by %s of a %s lobe", s.transmission ? "transmission" : "reflection",
          s.specular ? "delta" : "rough");
    if (s.transmission) t.add(", eta ").number(s.eta);
    t.end();
    t.label(2, "direction").vector(v.scattering->wi).end();
    t.label(2, s.specular ? "probability" : "density").number(s.pdf);
    if (!s.specular) t.add(" per steradian");
    t.end();
    t.columns(2, "weight", s.weight);
    add_roulette(t, v);
}

const char* name_of(const Quadric& quadric) {
    return std::visit(Overloaded{[](const Sphere&) { return "a sphere"; },
                                 [](const Disk&) { return "a disk"; },
                                 [](const Cylinder&) { return "a cylinder"; }},
                      quadric);
}

void add_vertex(Text& t, std::size_t number, const PathVertex& v, const std::vector<RayLight>& on_rays,
                const Scene& scene) {
    t.end().add("vertex %zu: ", number);
    if (v.surface) {
        const Shape& shape = *v.surface->shape;
        t.add("shape %u, ", static_cast<unsigned>(v.hit.shape));
        std::visit(
            Overloaded{[&](MeshIndex mesh) {
                           t.add("triangle %u of mesh %u", static_cast<unsigned>(v.hit.primitive),
                                 static_cast<unsigned>(mesh.index));
                       },
                       [&](QuadricIndex quadric) { t.add("%s", name_of(scene.quadrics[quadric.index])); },
                       [&](CurvesIndex curves) {
                           t.add("segment %u of curves %u", static_cast<unsigned>(v.hit.primitive),
                                 static_cast<unsigned>(curves.index));
                       },
                       [&](BilinearMeshIndex mesh) {
                           t.add("patch %u of bilinear mesh %u", static_cast<unsigned>(v.hit.primitive),
                                 static_cast<unsigned>(mesh.index));
                       }},
            shape.geometry);
        if (v.hit.instance != no_index) t.add(", instance %u", static_cast<unsigned>(v.hit.instance));
        t.add(", material %u", static_cast<unsigned>(shape.material)).end();
        t.label(1, "position").vector(v.surface->p).add(", distance ").number(v.hit.t).end();
        t.label(1, "geometric normal").vector(v.surface->ng).end();
        t.label(1, "shading normal").vector(v.bsdf ? v.bsdf->frame.n : v.surface->ns).end();
    } else if (v.medium) {
        t.add("in a medium").end();
        t.label(1, "position").vector(v.medium->p).add(", distance ");
        t.number(length(v.medium->p - v.ray.o)).end();
        t.columns(1, "absorption", v.medium->sigma_a);
        t.columns(1, "scattering", v.medium->sigma_s);
    } else {
        t.add("beyond the scene").end();
        t.label(1, "direction").vector(v.ray.d).end();
    }
    t.columns(1, "throughput", v.throughput);
    for (const RayLight& on_ray : on_rays)
        if (on_ray.vertex + 1 == number) add_direct(t, on_ray.light, scene, on_ray.distance);
    for (const FoundLight& found : v.found) add_found(t, found, scene);
    if (v.bsdf) {
        t.label(1, "BSDF");
        std::visit([&](const auto& b) { add_bsdf(t, b); }, v.bsdf->bsdf);
    }
    if (v.direct) add_direct(t, *v.direct, scene);
    if (v.scattering) add_scattering(t, v);
    if (v.medium && v.medium->scattered) {
        t.add("  continued by the phase function").end();
        t.label(2, "direction").vector(v.medium->wi).end();
        t.label(2, "density").number(v.medium->pdf).add(" per steradian").end();
        add_roulette(t, v);
    }
}

const char* sentence_of(PathEnd end) {
    switch (end) {
    case PathEnd::left_scene:
        return "the path left the scene";
    case PathEnd::max_depth:
        return "the path has as many scattering events as are allowed";
    case PathEnd::grazing:
        return "the ray lies in the plane of the surface";
    case PathEnd::no_direction:
        return "the BSDF sampled no direction";
    case PathEnd::nothing_carried:
        return "the throughput of the path is zero";
    case PathEnd::bad_throughput:
        return "the throughput is bad; it is added to the radiance, so that the sample is reported";
    case PathEnd::roulette:
        return "Russian roulette";
    case PathEnd::absorbed:
        return "a medium absorbed the path";
    }
    return "";
}

const char* name_of(BadSample::Kind kind) {
    return kind == BadSample::Kind::nan        ? "not a number"
           : kind == BadSample::Kind::infinite ? "infinite"
                                               : "negative";
}

const char* name_of(BadOrigin::Quantity quantity) {
    using Quantity = BadOrigin::Quantity;
    switch (quantity) {
    case Quantity::found_radiance:
        return "in the radiance of the light that the path met";
    case Quantity::found_density:
        return "in the densities of the light that the path met";
    case Quantity::direct_radiance:
        return "in the radiance of the sampled light";
    case Quantity::direct_density:
        return "in the densities of the sampled light";
    case Quantity::bsdf_value:
        return "in the value of the BSDF towards the sampled light";
    case Quantity::bsdf_weight:
        return "in the weight of the BSDF's sample";
    case Quantity::throughput:
        return "in the throughput, whose factors are good";
    case Quantity::product:
        return "in a contribution whose factors are good";
    case Quantity::sum:
        return "in the sum of contributions that are good";
    }
    return "";
}

void add_result(Text& t, const SampleRecord& r) {
    t.end().add("end: %s", sentence_of(r.path.end)).end();
    if (!(r.lambda_end == r.lambda)) {
        t.add("dispersion ended all wavelengths but the first").end();
        t.columns(1, "density, 1/nm", r.lambda_end.pdf);
    }
    if (!is_black(r.path.emission)) t.columns(1, "emitted by media", r.path.emission);
    t.columns(1, "radiance", r.path.radiance);
    t.end().label(1, "").add("%15s%15s%15s", "R", "G", "B").end();
    t.rgb(1, "sensor", r.sensor_rgb);
    if (r.clamp != 1) t.label(1, "times clamp").number(r.clamp, 15).end();
    t.label(1, "times filter").number(r.filter.weight, 15).end();
    if (r.background != Vec3f{}) t.rgb(1, "plus background", r.background);
    if (!r.bad) {
        t.rgb(1, "the pixel gets", r.contribution.radiance);
    } else {
        t.rgb(1, "the pixel would get", r.rgb);
        t.add("left out: it is %s", name_of(*r.bad));
        if (const auto origin = origin_of_bad(r.path))
            t.add(", first at vertex %zu, %s", origin->vertex + 1, name_of(origin->quantity)).end();
        else
            t.add(" once the sensor has seen it").end();
    }
}

} // namespace

std::string sample_record_text(const SampleRecord& r, const SceneDescription& d) {
    Text t;
    t.add("sample %llu of %u of pixel %d,%d, sampler %s, seed %llu, strategy %s",
          static_cast<unsigned long long>(r.index), d.sampler.spp, r.x, r.y, name_of(d.sampler.kind).data(),
          static_cast<unsigned long long>(d.sampler.seed), name_of(d.integrator.strategy).data());
    if (d.integrator.strategy >= Strategy::mis)
        t.add(" with the %s heuristic", name_of(d.integrator.heuristic).data());
    t.end();
    t.label(1, "film").number(r.film.x).add(", ").number(r.film.y);
    t.add("; filter weight ").number(r.filter.weight).end();
    t.label(1, "lens").number(r.lens.x).add(", ").number(r.lens.y).end();
    if (r.time > 0) t.label(1, "time").number(r.time).end();
    if (!r.path.vertices.empty()) {
        const Ray& ray = r.path.vertices.front().ray;
        t.label(1, "camera ray").add("from ").vector(ray.o).add(" along ").vector(ray.d).end();
    }
    t.columns(1, "wavelengths, nm", SampledSpectrum(r.lambda.lambda));
    t.columns(1, "density, 1/nm", r.lambda.pdf);
    for (std::size_t i = 0; i < r.path.vertices.size(); ++i)
        add_vertex(t, i + 1, r.path.vertices[i], r.path.on_rays, d.scene);
    add_result(t, r);
    return t.take();
}

} // namespace montelux
