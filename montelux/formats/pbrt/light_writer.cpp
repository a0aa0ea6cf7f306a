#include <algorithm>
#include <array>
#include <cmath>

#include "montelux/formats/pbrt/lights.h"
#include "montelux/formats/pbrt/scene_writer.h"
#include "montelux/mc/math/constants.h"
#include "montelux/mc/math/float_near.h"
#include "montelux/mc/math/overloaded.h"
#include "montelux/scene/build/emission.h"
#include "montelux/scene/scene_digest.h"

namespace montelux::pbrt {
namespace {

// Degrees of the cone with that cosine.
std::optional<float> cone_angle(float cosine) {
    const auto cosine_of = [](float degrees) {
        return static_cast<float>(std::cos(static_cast<double>(degrees) * pi / 180));
    };
    return float_near(
        std::acos(std::clamp(double{cosine}, -1.0, 1.0)) * 180 / pi,
        [&](float v) { return v >= 0 && cosine_of(v) == cosine; }, 4096);
}

// The colour space whose white is the spectrum; null if there is none.
const RgbColorSpace* space_of_white(const Spectrum& s) {
    const auto* table = std::get_if<TabulatedSpectrum>(&s.kind());
    if (table == nullptr) return nullptr;
    if (RgbColorSpace::srgb().illuminant().values() == table->data().values()) return &RgbColorSpace::srgb();
    for (const std::string_view name : rgb_color_space_names()) {
        const RgbColorSpace* space = find_rgb_color_space(name);
        if (space->illuminant().values() == table->data().values()) return space;
    }
    return nullptr;
}

// Of the colours of pictures.
float white_scale() { return photometric_scale(Spectrum(RgbColorSpace::srgb().illuminant())); }

} // namespace

void SceneWriter::group(DirectiveText& d, std::size_t light) const {
    if (light < scene_.light_groups.size() && !scene_.light_groups[light].empty())
        d.string("group", scene_.light_groups[light]);
}

// The spectrum `name` and the parameter "scale", so that the reader's product with photometric_scale is `scale`; if no
// float gives that, also `second`, by which the reader multiplies as well, `per_unit` for each unit of it.
void SceneWriter::source(DirectiveText& d, std::string_view name, SceneSpectrum spectrum_index, float scale,
                         const std::string& what, std::string_view second, float per_unit) {
    const Spectrum s = spectrum_of(spectrum_index, scene_.spectra);
    const RgbColorSpace* white = space_of_white(s);
    if (name.empty() || white == nullptr || !d.use_color_space(*white)) {
        if (!name.empty()) spectrum(d, name, s, RgbMeaning::illuminant, what);
    }
    const float unit = photometric_scale(s);
    if (unit == 0) return;
    const double guess = double{scale} / double{unit};
    if (const auto factor = float_near(guess, [&](float v) { return v * unit == scale; })) {
        if (*factor != 1) d.number("scale", *factor);
        return;
    }
    if (!second.empty())
        for (int k = 0; k < 64; ++k) {
            const float first = 1 + static_cast<float>(k) / 64, base = first * unit;
            const auto value = float_near(double{scale} / (double{base} * double{per_unit}), [&](float v) {
                if (second == "power") return base * point_intensity(v) == scale;
                if (second == "illuminance" && per_unit != 1) return base * sky_luminance(v) == scale;
                return base * v == scale;
            });
            if (!value || !(*value > 0)) continue;
            if (first != 1) d.number("scale", first);
            return d.number(second, *value);
        }
    d.number("scale", static_cast<float>(guess));
    warn(what, "its scale is kept to seven digits");
}

std::string SceneWriter::area_light(Index i, bool is_quadric, float area) {
    const auto& l = std::get<AreaLight>(scene_.lights[i]);
    const std::string what = "light " + std::to_string(i);
    DirectiveText d("AreaLightSource \"diffuse\"");
    if (l.equal_energy)
        warn(what, "its picture has the constant spectrum for white; pbrt takes an illuminant");
    if (l.picture != no_index) d.string("filename", environment_file(l.picture));
    if (l.picture != no_index && l.picture_lookup != PictureLookup::bilinear)
        warn(what, "pbrt interpolates its picture, and lets the border of it go on to the edges");
    const Spectrum s = spectrum_of(l.spectrum, scene_.spectra);
    const std::string_view name = l.picture != no_index ? "" : "L";
    if (l.primitive_flux > 0) {
        double mean = 1;
        if (l.picture != no_index) {
            const Image& image = scene_.environments[l.picture];
            const Vec3d weights = RgbColorSpace::srgb().luminance_weights();
            double sum = 0;
            for (std::size_t k = 0; k < image.sample_count(); ++k)
                sum += double(image.value_at(k)) * weights[static_cast<int>(k % 3)];
            mean = sum / static_cast<double>(image.pixel_count());
        }
        source(d, name, l.spectrum, l.scale, what);
        const double guess = double{l.primitive_flux} * mean;
        const auto flux = float_near(
            guess, [&](float v) { return static_cast<float>(double{v} / mean) == l.primitive_flux; });
        d.number("power", flux.value_or(static_cast<float>(guess)));
    } else {
        // The flux of a quadric is a factor of its scale.
        const float unit = photometric_scale(s);
        const auto plain =
            float_near(double{l.scale} / double{unit}, [&](float v) { return v * unit == l.scale; });
        std::optional<float> power, first;
        if (!plain && is_quadric && area > 0 && l.picture == no_index && unit > 0)
            for (int k = 0; k < 64 && !power; ++k) {
                first = 1 + static_cast<float>(k) / 64;
                const float base = *first * unit, per = (l.two_sided ? 2.0f : 1.0f) * area * pi_f;
                power = float_near(double{l.scale} / double{base} * double{per},
                                   [&](float v) { return v > 0 && base * (v / per) == l.scale; });
            }
        source(d, name, l.spectrum, power ? *first * unit : l.scale, what);
        if (power) d.number("power", *power);
    }
    if (l.two_sided) d.boolean("twosided", true);
    group(d, i);
    return d.text();
}

void SceneWriter::light(std::size_t i) {
    const std::string what = "light " + std::to_string(i);
    std::string transform;
    // A light that moves is in its own space.
    const auto place = [&](const Transform& own, Index motion) {
        if (motion == no_index) {
            transform = transform_text(own);
            return;
        }
        const Motion& m = scene_.motions[motion];
        transform = motion_text(m.start() * own, m.end() * own);
        if (!(own == Transform())) warn(what, "it moves from and to the same places, on a path of pbrt's");
    };
    const auto directive = [](const char* name) { return DirectiveText("LightSource " + quoted_text(name)); };
    const auto finish = [&](DirectiveText& d) {
        group(d, i);
        put_block(transform + d.text());
    };
    const auto unit = [](Vec3f v) { return v / length(v); };
    const auto portal = [](DirectiveText& d, const std::optional<Portal>& p) {
        if (!p) return;
        std::array<float, 12> corners{};
        for (std::size_t k = 0; k < 12; ++k) corners[k] = p->corners()[k / 3][static_cast<int>(k % 3)];
        d.numbers("point3", "portal", corners);
    };
    std::visit(
        Overloaded{
            [&](const AreaLight&) {}, // with its shape
            [&](const PointLight& l) {
                DirectiveText d = directive("point");
                place(Transform(), l.motion);
                source(d, "I", l.spectrum, l.scale, what, "power", 1 / (4 * pi_f));
                d.vector("point3", "from", l.position);
                finish(d);
            },
            [&](const SpotLight& l) {
                DirectiveText d = directive("spot");
                const Transform to_place = Transform::translate(Vec3d(l.position));
                place(l.motion == no_index ? Transform() * to_place : Transform(), l.motion);
                source(d, "I", l.spectrum, l.scale, what);
                const Vec3f from = l.motion == no_index ? Vec3f() : l.position;
                const Vec3f axis =
                    direction_giving(l.axis, [&](Vec3f v) { return unit(unit((from + v) - from)); });
                d.vector("point3", "from", from);
                d.vector("point3", "to", from + axis);
                const std::optional<float> total = cone_angle(l.cos_total_width),
                                           start = cone_angle(l.cos_falloff_start);
                const float cone = total.value_or(30);
                std::optional<float> delta;
                if (total && start)
                    delta = float_near(double{cone} - double{*start}, [&](float v) {
                        return static_cast<float>(std::cos(static_cast<double>(cone - v) * pi / 180)) ==
                               l.cos_falloff_start;
                    });
                if (!delta) warn(what, "the angles of its cone are kept to seven digits");
                if (l.profile != SpotFalloff::smooth)
                    warn(what, "its falloff, linear in the angle, becomes pbrt's smooth one");
                if (l.picture != no_index) warn(what, "its picture is left out");
                d.number("coneangle",
                         total.value_or(static_cast<float>(std::acos(double{l.cos_total_width}) * 180 / pi)));
                d.number("conedeltaangle",
                         delta.value_or(static_cast<float>(
                             (std::acos(double{l.cos_total_width}) - std::acos(double{l.cos_falloff_start})) *
                             180 / pi)));
                finish(d);
            },
            [&](const DistantLight& l) {
                DirectiveText d = directive("distant");
                place(Transform(), l.motion);
                source(d, "L", l.spectrum, l.scale, what, "illuminance", 1);
                d.vector("point3", "from",
                         direction_giving(l.to_light, [&](Vec3f v) { return unit(unit(v)); }));
                d.vector("point3", "to", {0, 0, 0});
                finish(d);
            },
            [&](const UniformInfiniteLight& l) {
                DirectiveText d = directive("infinite");
                if (l.portal) // needs a spectrum that is written
                    spectrum(d, "L", l.spectrum, RgbMeaning::illuminant, what);
                source(d, l.portal ? "" : "L", l.spectrum, l.scale, what, "illuminance", 1 / pi_f);
                portal(d, l.portal);
                finish(d);
            },
            [&](const ImageInfiniteLight& l) {
                DirectiveText d = directive("infinite");
                place(l.world_from_light, l.motion);
                d.string("filename", environment_file(l.environment));
                const Image& map = scene_.environments[l.environment];
                if (l.layout == EnvironmentLayout::equirectangular) {
                    d.string("layout", name_of(l.layout));
                    warn(what, "its map is latitude-longitude, which pbrt-v4 refuses ('imgtool makeequiarea' "
                               "converts it)");
                }
                map_scale(d, l.scale, white_scale(), what, upper_illuminance(map, l.layout), "illuminance");
                portal(d, l.portal);
                finish(d);
            },
            [&](const SkyLight& l) {
                place(l.world_from_light, l.motion);
                sky(i, l, transform);
            },
            [&](const SunLight&) {
                if (i + 1 >= scene_.lights.size() || !is_sun_of(i, i + 1))
                    warn(what, "a sun without its sky cannot be written in pbrt's syntax; it is left out");
            },
            [&](const GoniometricLight& l) {
                DirectiveText d = directive("goniometric");
                const Matrix4 swap_yz{{{{1, 0, 0, 0}, {0, 0, 1, 0}, {0, 1, 0, 0}, {0, 0, 0, 1}}}};
                place(l.world_from_map * Transform(swap_yz, swap_yz), l.motion);
                d.string("filename", environment_file(l.environment));
                source(d, "I", l.spectrum, l.scale, what);
                finish(d);
            },
            [&](const ProjectionLight& l) {
                DirectiveText d = directive("projection");
                if (l.profile != ProjectionProfile::intensity)
                    warn(what, "it lights planes across its axis evenly, which pbrt's projection does not");
                place(l.world_from_light, l.motion);
                d.number("fov", l.fov);
                d.string("filename", environment_file(l.environment));
                map_scale(d, l.scale, white_scale(), what, 0, {});
                finish(d);
            }},
        scene_.lights[i]);
}

// The parameter "scale" that the reader multiplies by `unit`, and if that is not enough `second`, over `flux`.
void SceneWriter::map_scale(DirectiveText& d, float scale, float unit, const std::string& what, double flux,
                            std::string_view second) {
    const double guess = double{scale} / double{unit};
    if (const auto factor = float_near(guess, [&](float v) { return v * unit == scale; })) {
        if (*factor != 1) d.number("scale", *factor);
        return;
    }
    for (int k = 0; k < 64 && flux > 0 && !second.empty(); ++k) {
        const float first = 1 + static_cast<float>(k) / 64, base = first * unit;
        const auto value = float_near(double{scale} / double{base} * flux, [&](float v) {
            return v > 0 && base * static_cast<float>(double{v} / flux) == scale;
        });
        if (!value) continue;
        if (first != 1) d.number("scale", first);
        return d.number(second, *value);
    }
    d.number("scale", static_cast<float>(guess));
    warn(what, "its scale is kept to seven digits");
}

bool SceneWriter::is_sun_of(std::size_t sun, std::size_t sky) const {
    const auto* s = std::get_if<SunLight>(&scene_.lights[sun]);
    const auto* l = std::get_if<SkyLight>(&scene_.lights[sky]);
    return s != nullptr && l != nullptr && s->scale == l->scale &&
           digest_of(spectrum_of(s->spectrum, scene_.spectra)) ==
               digest_of(Spectrum(scene_.skies[l->sky].sun_radiance()));
}

void SceneWriter::sky(std::size_t i, const SkyLight& l, const std::string& transform) {
    const std::string what = "light " + std::to_string(i);
    const SkyModel& model = scene_.skies[l.sky];
    const SkySettings& s = model.settings();
    DirectiveText d("LightSource \"sky\"");
    const auto same = [](double exact) {
        return [exact](float v) { return static_cast<double>(v) == exact; };
    };
    const auto elevation = float_near(s.elevation, same(s.elevation), 0),
               azimuth = float_near(s.azimuth, same(s.azimuth), 0);
    if (elevation && azimuth) {
        d.number("elevation", *elevation);
        d.number("azimuth", *azimuth);
    } else {
        // The sun was given by a direction.
        const auto angles_fit = [&](Vec3f v) {
            const Vec3d w(v);
            return std::atan2(w.z, std::hypot(w.x, w.y)) * 180 / pi == s.elevation &&
                   std::atan2(w.y, w.x) * 180 / pi == s.azimuth;
        };
        const double e = s.elevation * pi / 180, a = s.azimuth * pi / 180;
        const Vec3d sun(std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e));
        std::optional<Vec3f> found;
        // Most are written with one component of few digits.
        for (int axis = 0; axis < 3 && !found; ++axis)
            for (int k = 1; k <= 1000 && !found; ++k) {
                if (std::abs(sun[axis]) < 1e-9) break;
                const Vec3d v = sun * (static_cast<double>(k) / 100 / std::abs(sun[axis]));
                for (int digits = 1; digits <= 7 && !found; ++digits) {
                    const Vec3f candidate(rounded_to_digits(v.x, digits), rounded_to_digits(v.y, digits),
                                          rounded_to_digits(v.z, digits));
                    if (angles_fit(candidate)) found = candidate;
                }
            }
        if (found) {
            d.vector("vector3", "sun", *found);
        } else {
            d.number("elevation", static_cast<float>(s.elevation));
            d.number("azimuth", static_cast<float>(s.azimuth));
            warn(what, "the place of the sun is kept to seven digits");
        }
    }
    const AtmosphereSettings& air = s.atmosphere;
    const AtmosphereSettings standard;
    if (!float_near(air.turbidity, same(air.turbidity), 0))
        warn(what, "its turbidity is kept to seven digits");
    d.number("turbidity", static_cast<float>(air.turbidity));
    if (air.angstrom_exponent != standard.angstrom_exponent ||
        air.aerosol_albedo != standard.aerosol_albedo || air.aerosol_g != standard.aerosol_g ||
        air.ozone != standard.ozone)
        warn(what, "the sky's scene syntax has no parameters of its aerosol and ozone; the standard ones are "
                   "written");
    if (s.ground_albedo.is_constant())
        d.number("groundalbedo", s.ground_albedo(550));
    else
        spectrum(d, "groundalbedo", s.ground_albedo, RgbMeaning::albedo, what);
    const bool shines = model.sun_radiance().max_value() > 0;
    if (shines && (i == 0 || !is_sun_of(i - 1, i))) d.boolean("sundisc", false);
    const bool with_sun = shines && i > 0 && is_sun_of(i - 1, i);
    const SpectrumTable from_sky = model.sky_irradiance(), from_sun = model.sun_irradiance();
    const double illuminance = luminous_efficacy * integrate_luminance([&](float lambda) {
                                   return from_sky(lambda) + (with_sun || !shines ? from_sun(lambda) : 0);
                               });
    map_scale(d, l.scale, static_cast<float>(luminous_efficacy), what, illuminance, "illuminance");
    group(d, i);
    put_block(transform + d.text());
}

void SceneWriter::lights_before(std::size_t end) {
    for (; lights_ < end; ++lights_) light(lights_);
}

} // namespace montelux::pbrt
