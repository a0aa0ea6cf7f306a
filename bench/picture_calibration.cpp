// Pictures with errors compared with converged references: how often errors cover the truth, and whether
// renders to an error reach it.
#include <boost/math/distributions/students_t.hpp>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "montelux/film/pixel_warnings.h"
#include "montelux/formats/load_scene.h"
#include "montelux/image/image_read.h"
#include "montelux/image/metrics.h"
#include "montelux/mc/math/compensated.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/stats/moments.h"
#include "montelux/render/renderer.h"
#include "montelux/render/tile_renderer.h"

using namespace montelux;

namespace {

struct Options {
    std::filesystem::path scenes; // of folders with scene.pbrt, ref/mean.exr and ref/stderr.exr
    std::vector<std::string> names{"cornell-box",     "veach-mis",     "material-testball",
                                   "killeroo-simple", "killeroo-gold", "coffee"};
    std::vector<std::string> samplers{"independent", "sobol"};
    std::vector<bool> adaptive{false, true};
    std::uint32_t spp = 256;
    std::vector<double> targets;
    double time = 0; // seconds at most, for a target
    std::uint64_t seed = 1;
    int renders = 0; // of each target, compared with one another instead of the reference
    int width = 160; // of those, in pixels
};

struct Reference {
    Image mean, error;
};

// Of scores z of pixels and channels, errors of both pictures taken together; and what to expect of them
// where errors are estimated, from few replicates: Student's law with the degrees of freedom of Welch 1947,
// "The Generalization of 'Student's' Problem when Several Different Population Variances are Involved".
struct Coverage {
    double count = 0, one = 0, two = 0, expected_one = 0, expected_two = 0;
    void add(double z, double degrees_of_freedom) {
        const boost::math::students_t law(degrees_of_freedom);
        ++count;
        one += std::abs(z) <= 1;
        two += std::abs(z) <= 2;
        expected_one += 1 - 2 * cdf(law, -1.0);
        expected_two += 1 - 2 * cdf(law, -2.0);
    }
    double percent(double sum) const { return 100 * sum / count; }
};
double welch(double variance_a, double freedom_a, double variance_b, double freedom_b) {
    const double sum = variance_a + variance_b;
    return sum * sum / (variance_a * variance_a / freedom_a + variance_b * variance_b / freedom_b);
}
// The references' errors come from eight pictures.
constexpr double reference_freedom = 7;

struct Figures {
    FilmError claimed;
    double true_error = 0;      // root mean square of the luminance's, over the reference's mean
    double reference_error = 0; // the same of the reference's own error, which true_error excludes
    double warned_share = 0;    // of the pixels, in the layer `warning`
    Coverage all, sure;         // all pixels, and those without a warning
    RenderReport report;
};

SamplerSettings sampler_settings(const std::string& sampler, std::uint64_t seed, std::uint32_t spp) {
    return {sampler == "independent" ? SamplerKind::independent : SamplerKind::sobol, seed, spp};
}
void shrink(SceneDescription& d, int width) {
    d.film.height = std::max(1, d.film.height * width / d.film.width);
    d.film.width = width;
    d.film.crop = {0, 0, d.film.width, d.film.height};
}

Figures render(SceneDescription d, const Reference& reference, const std::string& sampler, bool adaptive,
               const RenderTarget& target, std::uint32_t spp, std::uint64_t seed) {
    d.sampler = sampler_settings(sampler, seed, spp);
    RenderTarget t = target;
    t.adaptive = adaptive;
    Film film(d.film);
    Figures f;
    f.report = Renderer(d, t).render(film);
    f.claimed = film.error();

    const Image picture = film.develop();
    const MeasuredPicture a = measured_picture("picture", picture);
    const MeasuredPicture b = measured_picture("reference", reference.mean, "its errors", reference.error);
    CompensatedSum square, own, mean;
    const std::vector<PixelWarning> warnings = pixel_warnings(film);
    std::size_t i = 0, warned = 0;
    for (int y = 0; y < picture.height(); ++y)
        for (int x = 0; x < picture.width(); ++x, ++i) {
            const bool warned_pixel = marks_unreliable_error(warnings[i]);
            const auto replicates = static_cast<double>(film.pixels()[i].replicates().count());
            double luminance = 0, difference = 0, error = 0;
            for (int c = 0; c < 3; ++c) {
                const double w = luminance_weight[c], distance = a.value(x, y, c) - b.value(x, y, c);
                luminance += w * b.value(x, y, c);
                difference += w * distance;
                error += w * b.standard_error(x, y, c);
                const double va = std::pow(a.standard_error(x, y, c), 2),
                             vb = std::pow(b.standard_error(x, y, c), 2);
                if (!(va + vb > 0)) continue;
                const double z = distance / std::sqrt(va + vb),
                             freedom = welch(va, replicates - 1, vb, reference_freedom);
                f.all.add(z, freedom);
                if (!warned_pixel) f.sure.add(z, freedom);
            }
            mean.add(luminance);
            square.add(difference * difference - error * error);
            own.add(error * error);
            warned += warned_pixel;
        }
    const auto n = static_cast<double>(i);
    f.true_error = std::sqrt(std::max(0.0, square.value() / n)) / (mean.value() / n);
    f.reference_error = std::sqrt(own.value() / n) / (mean.value() / n);
    f.warned_share = static_cast<double>(warned) / n;
    return f;
}

void print_coverage(const Options& o, const std::string& name, const SceneDescription& d,
                    const Reference& r) {
    for (const std::string& sampler : o.samplers)
        for (bool adaptive : o.adaptive) {
            const Figures f = render(d, r, sampler, adaptive, {}, o.spp, o.seed);
            std::printf("| %s | %s | %s | %.1f | %.1f (%.1f) | %.1f (%.1f) | %.2f | %.1f (%.1f) | %.1f "
                        "(%.1f) | %.2f | %.2f |\n",
                        name.c_str(), sampler.c_str(), adaptive ? "on" : "off", f.claimed.mean_samples,
                        f.all.percent(f.all.one), f.all.percent(f.all.expected_one), f.all.percent(f.all.two),
                        f.all.percent(f.all.expected_two), 100 * f.warned_share, f.sure.percent(f.sure.one),
                        f.sure.percent(f.sure.expected_one), f.sure.percent(f.sure.two),
                        f.sure.percent(f.sure.expected_two), 100 * f.claimed.relative, 100 * f.true_error);
            std::fflush(stdout);
        }
}

void print_targets(const Options& o, const std::string& name, const SceneDescription& d, const Reference& r) {
    for (double target : o.targets)
        for (const std::string& sampler : o.samplers)
            for (bool adaptive : o.adaptive) {
                const Figures f =
                    render(d, r, sampler, adaptive, {.error = target, .time = o.time}, 1u << 30, o.seed);
                std::printf("| %s | %g %% | %s | %s | %.1f | %.2f %% | %.2f %% | %.2f | %.2f %% | %s |\n",
                            name.c_str(), 100 * target, sampler.c_str(), adaptive ? "on" : "off",
                            f.claimed.mean_samples, 100 * f.claimed.relative, 100 * f.true_error,
                            f.true_error / target, 100 * f.reference_error,
                            std::string(to_string(f.report.stop)).c_str());
                std::fflush(stdout);
            }
}

// The true error of a render to an error, from the spread of many: it needs no reference, so no target is too
// small.
void print_spread(const Options& o, const std::string& name, SceneDescription d) {
    shrink(d, o.width);
    for (double target : o.targets)
        for (const std::string& sampler : o.samplers)
            for (bool adaptive : o.adaptive) {
                std::vector<RunningMoments> pixels(pixel_count(d.film.crop));
                RunningMoments claimed, samples, reached;
                for (int k = 0; k < o.renders; ++k) {
                    d.sampler = sampler_settings(sampler, o.seed + static_cast<std::uint64_t>(k), 1u << 24);
                    Film film(d.film);
                    const RenderReport report =
                        Renderer(d, {.error = target, .time = o.time, .adaptive = adaptive}).render(film);
                    claimed.add(film.error().relative);
                    samples.add(film.error().mean_samples);
                    reached.add(report.stop == RenderStop::error);
                    for (std::size_t i = 0; i < pixels.size(); ++i) {
                        const auto& u = film.pixels()[i].replicates();
                        pixels[i].add(luminance_weight.x * u.mean(0) + luminance_weight.y * u.mean(1) +
                                      luminance_weight.z * u.mean(2));
                    }
                }
                CompensatedSum variance, mean;
                for (const RunningMoments& p : pixels) {
                    variance.add(p.variance());
                    mean.add(p.mean());
                }
                const auto n = static_cast<double>(pixels.size());
                const double error = std::sqrt(variance.value() / n) / (mean.value() / n);
                std::printf("| %s | %g %% | %s | %s | %.1f | %.2f %% | %.2f %% | %.2f | %.0f of %d |\n",
                            name.c_str(), 100 * target, sampler.c_str(), adaptive ? "on" : "off",
                            samples.mean(), 100 * claimed.mean(), 100 * error, error / target,
                            reached.mean() * o.renders, o.renders);
                std::fflush(stdout);
            }
}

// Coverage again, by renders beside the mean of the others instead of the reference: what a difference to
// pbrt-v4 adds to it is missing here.
void print_own_coverage(const Options& o, const std::string& name, SceneDescription d) {
    shrink(d, o.width);
    for (const std::string& sampler : o.samplers)
        for (bool adaptive : o.adaptive) {
            const std::size_t pixels = pixel_count(d.film.crop);
            struct Channel {
                float mean, error, replicates;
                bool warned_pixel;
            };
            std::vector<Channel> renders;
            std::vector<RunningMoments> truth(3 * pixels);
            for (int k = 0; k < o.renders; ++k) {
                d.sampler = sampler_settings(sampler, o.seed + static_cast<std::uint64_t>(k), o.spp);
                Film film(d.film);
                Renderer(d, {.adaptive = adaptive}).render(film);
                const std::vector<PixelWarning> warnings = pixel_warnings(film);
                for (std::size_t i = 0; i < pixels; ++i)
                    for (int c = 0; c < 3; ++c) {
                        const auto& u = film.pixels()[i].replicates();
                        const double n = static_cast<double>(u.count());
                        renders.push_back({static_cast<float>(u.mean(c)),
                                           static_cast<float>(std::sqrt(u.variance(c) / n)),
                                           static_cast<float>(n), marks_unreliable_error(warnings[i])});
                        truth[3 * i + static_cast<std::size_t>(c)].add(u.mean(c));
                    }
            }
            const double others = o.renders - 1;
            Coverage all, sure;
            std::size_t warned = 0;
            CompensatedSum claimed, spread;
            for (std::size_t j = 0; j < renders.size(); ++j) {
                const Channel& r = renders[j];
                const RunningMoments& t = truth[j % truth.size()];
                const double own = static_cast<double>(r.mean), error = static_cast<double>(r.error);
                const double mean = (t.mean() * o.renders - own) / others;
                const double va = error * error, vb = t.variance() / others;
                warned += r.warned_pixel;
                if (va + vb > 0) {
                    const double z = (own - mean) / std::sqrt(va + vb),
                                 freedom = welch(va, static_cast<double>(r.replicates) - 1, vb, others - 1);
                    all.add(z, freedom);
                    if (!r.warned_pixel) sure.add(z, freedom);
                }
                claimed.add(va);
                spread.add(t.variance());
            }
            std::printf("| %s | %s | %s | %u | %.1f (%.1f) | %.1f (%.1f) | %.2f | %.1f (%.1f) | %.1f (%.1f) "
                        "| %.3f |\n",
                        name.c_str(), sampler.c_str(), adaptive ? "on" : "off", o.spp, all.percent(all.one),
                        all.percent(all.expected_one), all.percent(all.two), all.percent(all.expected_two),
                        100.0 * static_cast<double>(warned) / static_cast<double>(renders.size()),
                        sure.percent(sure.one), sure.percent(sure.expected_one), sure.percent(sure.two),
                        sure.percent(sure.expected_two), claimed.value() / spread.value());
            std::fflush(stdout);
        }
}

constexpr const char* usage =
    "Usage: picture_calibration SCENES [option value]...\n"
    "Errors of pictures beside the references in SCENES/<scene>/ref.\n"
    "  --scene A,B    some of the scenes\n"
    "  --sampler A,B  independent, sobol\n"
    "  --adaptive A,B on, off\n"
    "  --spp N        samples per pixel, for the shares of pixels within their errors [256]\n"
    "  --target X,Y   target errors, instead of these shares\n"
    "  --time S       seconds for each of these at most\n"
    "  --renders N    measure by the spread of N renders, not by the reference\n"
    "  --width N      of these, in pixels [160]\n"
    "  --seed N       [1]\n";

std::vector<std::string> items_of(const std::string& list) {
    std::vector<std::string> items;
    std::istringstream in(list);
    for (std::string item; std::getline(in, item, ',');) items.push_back(item);
    return items;
}
template <typename T>
T number_of(const std::string& option, const std::string& text) {
    T value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size())
        throw Error(option, "'" + text + "' is not a number");
    return value;
}

Options parse(const std::vector<std::string>& arguments) {
    if (arguments.size() % 2 != 1) throw Error("arguments", std::string("they do not fit\n") + usage);
    Options o;
    o.scenes = arguments[0];
    for (std::size_t i = 1; i < arguments.size(); i += 2) {
        const std::string &option = arguments[i], &value = arguments[i + 1];
        if (option == "--scene")
            o.names = items_of(value);
        else if (option == "--sampler")
            o.samplers = items_of(value);
        else if (option == "--adaptive") {
            o.adaptive.clear();
            for (const std::string& x : items_of(value)) {
                if (x != "on" && x != "off") throw Error(option, "'" + x + "' is neither on nor off");
                o.adaptive.push_back(x == "on");
            }
        } else if (option == "--spp")
            o.spp = number_of<std::uint32_t>(option, value);
        else if (option == "--target")
            for (const std::string& x : items_of(value)) o.targets.push_back(number_of<double>(option, x));
        else if (option == "--time")
            o.time = number_of<double>(option, value);
        else if (option == "--renders")
            o.renders = number_of<int>(option, value);
        else if (option == "--width")
            o.width = number_of<int>(option, value);
        else if (option == "--seed")
            o.seed = number_of<std::uint64_t>(option, value);
        else
            throw Error(option, std::string("no such option\n") + usage);
    }
    for (const std::string& sampler : o.samplers)
        if (sampler != "independent" && sampler != "sobol")
            throw Error("--sampler", "'" + sampler + "' is neither independent nor sobol");
    return o;
}

} // namespace

int main(int argc, char** argv) try {
    const Options o = parse({argv + 1, argv + argc});
    if (o.targets.empty() && o.renders > 0)
        std::printf("| scene | sampler | adaptive | spp | within 1 | within 2 | warned | others within "
                    "1 | within 2 | variance claimed / true |\n"
                    "|---|---|---|--:|--:|--:|--:|--:|--:|--:|\n");
    else if (o.targets.empty())
        std::printf("| scene | sampler | adaptive | spp | within 1 | within 2 | warned | others within 1 | "
                    "within 2 | error claimed | true |\n|---|---|---|--:|--:|--:|--:|--:|--:|--:|--:|\n");
    else if (o.renders > 0)
        std::printf("| scene | asked | sampler | adaptive | spp | claimed | true | true / asked | reached |\n"
                    "|---|--:|---|---|--:|--:|--:|--:|--:|\n");
    else
        std::printf("| scene | asked | sampler | adaptive | spp | claimed | true | true / asked | "
                    "reference's | stopped by |\n|---|--:|---|---|--:|--:|--:|--:|--:|---|\n");
    for (const std::string& name : o.names) {
        Warnings warnings;
        const std::filesystem::path folder = o.scenes / name;
        const SceneDescription d = load_scene(folder / "scene.pbrt", warnings);
        if (o.renders > 0) {
            o.targets.empty() ? print_own_coverage(o, name, d) : print_spread(o, name, d);
            continue;
        }
        const Reference r{read_image(folder / "ref" / "mean.exr"), read_image(folder / "ref" / "stderr.exr")};
        if (o.targets.empty())
            print_coverage(o, name, d, r);
        else
            print_targets(o, name, d, r);
    }
    return 0;
} catch (const std::exception& e) {
    std::fprintf(stderr, "%s\n", e.what());
    return 1;
}
