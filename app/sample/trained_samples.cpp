// montelux sample --from: weighted and unweighted samples, and histograms, of a trained density.
#include "app/commands.h"
#include "app/integrate/density_notes.h"
#include "app/interrupt.h"
#include "app/output_files.h"
#include "app/progress_line.h"
#include "app/sample/sample_options.h"
#include "app/usage_error.h"
#include <chrono>
#include <cmath>
#include <cstdio>

#include "montelux/mc/integrate/trained/expectations.h"
#include "montelux/mc/integrate/trained/observables.h"
#include "montelux/mc/integrate/trained/samples.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/parallel/parallel_for.h"

namespace montelux::app {
namespace {

// A density with the problem that it was trained on.
struct Source {
    IntegrationTask task;
    TrainedDensity density;

    Integrand target() const { return Integrand::batch(task.integrand.function, task.integrand.count()); }
};

Source read_source(const std::string& path) {
    const auto notes = TrainedDensity::notes_of(path);
    IntegrationTask task = make_task(options_of_notes(notes, path));
    if (const std::string changed = changed_function(notes); !changed.empty())
        std::fprintf(stderr, "montelux: warning: %s\n", changed.c_str());
    TrainedDensity density = TrainedDensity::load(path, task.domain);
    return {std::move(task), std::move(density)};
}

UnweightingOptions sampling_options(const SampleOptions& o, const Source& source) {
    UnweightingOptions options;
    options.seed = whole_number(o.seed, "--seed", 0, UINT64_MAX);
    options.threads = static_cast<int>(whole_number(o.threads, "--threads", 0, most_threads));
    options.form = source.task.logarithm ? IntegrandForm::logarithm : IntegrandForm::value;
    options.cancel = &cancel_on_signals();
    if (!o.max_draws.empty()) options.max_draws = whole_number(o.max_draws, "--max-draws", 1, UINT64_MAX);
    if (!o.pilot.empty()) options.pilot = whole_number(o.pilot, "--pilot", 1, 1 << 24);
    if (!o.overweight_share.empty()) {
        options.overweight_share = constant(o.overweight_share, "--overweight-share");
        if (!(options.overweight_share >= 0 && options.overweight_share < 1))
            throw UsageError("--overweight-share",
                             "'" + o.overweight_share + "' was given; expected a number in [0, 1)");
    }
    return options;
}

void say(const std::string& text) { std::fprintf(stderr, "montelux: %s\n", text.c_str()); }
void say_warnings(const std::vector<std::string>& warnings) {
    for (const std::string& warning : warnings) say("warning: " + warning);
}

// 3.142(12), or log Z.
std::string integral_text(const Estimate& integral, double log_reference, bool logarithm) {
    const Estimate plain{integral.value, integral.standard_error};
    if (!logarithm) return "integral " + to_string(plain);
    return "log Z = " + to_string(Estimate{std::log(plain.value) + log_reference, plain.relative_error()});
}

void write_samples(const SampleOptions& o, const Source& source, const Samples& s) {
    std::vector<std::string> names = source.task.variables;
    for (int c = 1; c < s.f.components(); ++c)
        names.push_back(source.task.integrand.names[static_cast<std::size_t>(c)]);
    names.push_back("weight");
    TableWriter table(o.output, format_of(o), names, s.count());
    std::vector<double> row(names.size());
    for (std::size_t i = 0; i < s.count(); ++i) {
        s.x.view().gather(i, row.data());
        const auto n = static_cast<std::size_t>(s.x.dimensions());
        for (int c = 1; c < s.f.components(); ++c) row[n + static_cast<std::size_t>(c) - 1] = s.f(i, c);
        row.back() = s.weight[i];
        table.add(row);
    }
    table.finish();
}

int draw_samples(const SampleOptions& o, const Source& source) {
    UnweightingOptions options = sampling_options(o, source);
    const std::uint64_t n = whole_number(o.n, "--n", 1, std::uint64_t{1} << 36);
    ProgressLine line(o.quiet);
    const auto begin = std::chrono::steady_clock::now();
    options.progress = [&](double share) {
        const double seconds =
            std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
        if (line.due(seconds))
            line.show("sampling", percent_text(share) + " of " + count_text(static_cast<double>(n)) +
                                      "samples, " + duration_text(seconds));
    };
    UnweightedSamples s;
    if (o.unweighted)
        s = unweighted_samples(source.density, source.target(), n, options);
    else
        static_cast<Samples&>(s) = weighted_samples(source.density, source.target(), n, options);
    line.finish();
    if (options.cancel->requested()) return exit_interrupted; // a part of the samples would pass for all
    finish_on_signals();
    write_samples(o, source, s);
    say_warnings(s.warnings);
    if (o.quiet) return s.count() == n ? exit_done : exit_stopped;
    const std::string integral = integral_text(s.integral, s.log_reference, source.task.logarithm);
    char text[200];
    if (o.unweighted) {
        std::snprintf(text, sizeof text, "%zu unweighted samples, efficiency %s, ", s.count(),
                      to_string(Estimate{s.efficiency.value, s.efficiency.standard_error}).c_str());
        say(text + integral);
        if (s.overweight > 0) {
            std::snprintf(text, sizeof text,
                          "%llu of them weigh more than 1, at most %.3g; %.2g %% of the weight is beyond 1",
                          static_cast<unsigned long long>(s.overweight), s.largest_weight,
                          100 * s.overweight_share);
            say(text);
        }
    } else {
        std::snprintf(text, sizeof text, "%zu weighted samples, worth %.0f unweighted ones, ", s.count(),
                      s.effective_sample_size());
        say(text + integral);
    }
    return s.count() == n ? exit_done : exit_stopped;
}

// 'sqrt(s)=80:100:40'
struct HistogramRequest {
    std::string observable;
    std::vector<double> edges;
};
HistogramRequest read_histogram(const std::string& text, const NamedConstants& constants) {
    const std::string expected = "; expected OBSERVABLE=LOWER:UPPER:BINS, for example 'sqrt(s)=80:100:40'";
    const std::size_t equals = text.rfind('='),
                      first = text.find(':', equals == std::string::npos ? 0 : equals),
                      second = first == std::string::npos ? first : text.find(':', first + 1);
    if (equals == std::string::npos || equals == 0 || second == std::string::npos ||
        text.find(':', second + 1) != std::string::npos)
        throw UsageError("--histogram", "'" + text + "' was given" + expected);
    const double lower = constant(text.substr(equals + 1, first - equals - 1), "--histogram", constants);
    const double upper = constant(text.substr(first + 1, second - first - 1), "--histogram", constants);
    if (!(std::isfinite(lower) && std::isfinite(upper) && lower < upper))
        throw UsageError("--histogram",
                         "'" + text + "' has no finite lower end below an upper one" + expected);
    const std::uint64_t bins =
        whole_number(text.substr(second + 1), "--histogram", 1, Expectations::most_observables);
    HistogramRequest request{text.substr(0, equals), {}};
    for (std::uint64_t k = 0; k <= bins; ++k)
        request.edges.push_back(
            k == bins ? upper : lower + (upper - lower) * static_cast<double>(k) / static_cast<double>(bins));
    return request;
}

int draw_histogram(const SampleOptions& o, const Source& source) {
    const UnweightingOptions options = sampling_options(o, source);
    const HistogramRequest request = read_histogram(o.histogram, source.task.constants);
    const Formulas observable({request.observable}, source.task.variables, "--histogram",
                              source.task.constants);
    const Integrand bins = histogram_bins(
        Integrand::batch([observable](const PointBatch& x, ValueBatch y) { observable(x, y); }),
        request.edges);
    const std::uint64_t n = whole_number(o.n, "--n", 2, std::uint64_t{1} << 50);
    const Expectations e = expectations(source.density, source.target(), bins, n, options);
    if (e.cancelled) return exit_interrupted;
    finish_on_signals();
    // Of a logarithm the integrals may be beyond all numbers: shares of Z.
    const bool shares = source.task.logarithm;
    const auto m = static_cast<std::size_t>(e.observables());
    std::vector<double> value, covariance;
    if (shares) {
        value = e.mean();
        covariance = e.mean_covariance();
    } else {
        value.assign(e.integral.begin() + 1, e.integral.end());
        for (std::size_t a = 1; a <= m; ++a)
            for (std::size_t b = 1; b <= m; ++b) covariance.push_back(e.integral_covariance[a * (m + 1) + b]);
    }
    std::vector<std::string> names{"lower", "upper", shares ? "share" : "value", "standard_error"};
    for (std::size_t b = 1; o.covariance && b <= m; ++b) names.push_back("covariance_" + std::to_string(b));
    TableWriter table(o.output, format_of(o), names, m);
    for (std::size_t k = 0; k < m; ++k) {
        std::vector<double> row{request.edges[k], request.edges[k + 1], value[k],
                                std::sqrt(covariance[k * m + k])};
        for (std::size_t b = 0; o.covariance && b < m; ++b) row.push_back(covariance[k * m + b]);
        table.add(row);
    }
    table.finish();
    if (!o.quiet)
        say(std::to_string(m) + " bins from " + std::to_string(n) + " draws, " +
            integral_text({e.integral[0], std::sqrt(e.integral_covariance[0])}, e.log_reference, shares));
    say_warnings(e.warnings);
    return exit_done;
}

} // namespace

int run_trained_samples(const SampleOptions& o) {
    end_on_signals();
    if (o.unweighted && !o.histogram.empty())
        throw UsageError("--unweighted",
                         "a histogram takes all draws with their weights; leave out one of both");
    for (const auto& [option, text] :
         {std::pair("--pilot", &o.pilot), std::pair("--overweight-share", &o.overweight_share)})
        if (!text->empty() && !o.unweighted) throw UsageError(option, "expected --unweighted with it");
    if (!o.max_draws.empty() && !o.histogram.empty())
        throw UsageError("--max-draws", "a histogram takes --n draws; leave it out with --histogram");
    if (o.covariance && o.histogram.empty()) throw UsageError("--covariance", "expected --histogram with it");
    const Source source = read_source(o.from);
    if (!o.output.empty()) {
        check_output_names({o.output}, {o.from});
        check_output(o.output);
    }
    return o.histogram.empty() ? draw_samples(o, source) : draw_histogram(o, source);
}

} // namespace montelux::app
