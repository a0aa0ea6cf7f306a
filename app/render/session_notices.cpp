#include "app/render/session_notices.h"

#include "app/progress_line.h"
#include "app/render/memory_text.h"
#include <cstdio>
#include <string>

#include "montelux/render/render_warnings.h"
#include "montelux/scene/setting_names.h"
#include "montelux/transport/manifold/casters.h"

namespace montelux::app {

void print_bad_samples(const BadSampleReport& bad, std::uint64_t seed, bool can_replay) {
    if (bad.count() == 0) return;
    if (!can_replay) {
        std::fprintf(stderr, "montelux: warning: %s\n", bad_sample_warning(bad, seed).c_str());
        return;
    }
    std::fprintf(stderr, "montelux: warning: %s; to see its path, add --debug-sample %d,%d,%llu\n",
                 bad_sample_warning(bad, seed).c_str(), bad.first->x, bad.first->y,
                 static_cast<unsigned long long>(bad.first->sample));
}

namespace {

void print_chains(const ChainStatistics& s) {
    const auto number = [](std::uint64_t n) { return static_cast<unsigned long long>(n); };
    std::printf(
        "chains             %llu groups of %llu chains of %llu states, from %llu independent paths each\n",
        number(s.groups), number(s.chains), number(s.states), number(s.starting_points));
    std::printf("small steps        %.1f %% accepted, of at most %.3g\n", 100 * s.small_acceptance(),
                double(s.longest_step));
    std::printf("large steps        %.1f %% accepted, %.0f %% of all\n", 100 * s.large_acceptance(),
                100 * double(s.large_step_probability));
    std::printf("agreement          R-hat %.3f over groups\n", s.agreement.worst_r_hat());
}

void print_casters(const SceneView& scene) {
    const Casters casters(scene);
    std::size_t lights = 0;
    for (Index i = 0; i < static_cast<Index>(scene.lights.size()); ++i) lights += casters.covers(i) ? 1 : 0;
    std::printf("manifold sampling  %zu of %zu shapes are casters, for %zu of %zu lights\n",
                casters.all().size(), scene.shapes.size(), lights, scene.lights.size());
}

} // namespace

void print_statistics(const RenderReport& report, const OutlierReport& outliers, double load_seconds,
                      const Renderer& renderer) {
    auto samples = static_cast<double>(report.samples), rays = static_cast<double>(report.rays.rays());
    std::printf("load               %.3f s\n", load_seconds);
    std::printf("build              %.3f s\n", renderer.build_seconds());
    std::printf("render             %.3f s, %.3f s of CPU\n", report.seconds, report.cpu_seconds);
    if (const IntegratorChoice& choice = report.choice; choice.decided) {
        std::printf("integrator         %s\n", choice_text(choice).c_str());
        std::printf("pilots             %.3f s of CPU, of", choice.cpu_seconds);
        for (const IntegratorChoice::Candidate& c : choice.candidates)
            if (c.outcome == CandidateOutcome::measured)
                std::printf(" %llu samples by %s", static_cast<unsigned long long>(c.samples),
                            std::string(name_of(c.kind)).c_str());
        std::printf("\n");
    }
    std::printf("samples            %ssamples/s, %.3f us of CPU each\n",
                count_text(samples / report.seconds).c_str(), 1e6 * report.cpu_seconds / samples);
    const double checked = static_cast<double>(outliers.pixels - outliers.unknown);
    std::printf(
        "error bars         checked in %s of the pixels, those with 16 replicates (layer replicates)\n",
        percent_text(checked / static_cast<double>(outliers.pixels)).c_str());
    std::printf(
        "rays               %srays/s, %srays/s of CPU, %.2f per sample (%.2f closest hit, %.2f occlusion)\n",
        count_text(rays / report.seconds).c_str(), count_text(rays / report.cpu_seconds).c_str(),
        rays / samples, static_cast<double>(report.rays.closest) / samples,
        static_cast<double>(report.rays.occlusion) / samples);
    if (report.chains.groups > 0) print_chains(report.chains);
    if (const MergingSummary& m = report.merging; m.first_radius > 0)
        std::printf(
            "merging            radius %.4g to %.4g, %llu of %llu light paths of a pass, map of %.1f MiB\n",
            m.first_radius, m.last_radius, static_cast<unsigned long long>(m.light_paths),
            static_cast<unsigned long long>(m.of_paths), static_cast<double>(m.bytes) / (1 << 20));
    std::printf("inside Embree      %.1f %% of the CPU time\n",
                100 * report.ray_seconds / report.cpu_seconds);
    std::printf("peak memory        %.1f MiB\n", static_cast<double>(peak_memory()) / (1 << 20));
    if (const GuideSummary& guide = report.guide; guide.bytes > 0)
        std::printf(
            "guide              %llu regions, %.1f MiB, from %.3g samples per pixel in %u rounds, %.2f "
            "s of CPU; "
            "gain %.2g\n",
            static_cast<unsigned long long>(guide.regions), static_cast<double>(guide.bytes) / (1 << 20),
            guide.samples, guide.rounds, guide.cpu_seconds, guide.gain);
    else if (guide.outcome == GuideOutcome::too_short)
        std::printf("guide              none: the render is too short to try one\n");
    else if (guide.outcome == GuideOutcome::nothing_found)
        std::printf("guide              none: no light was found to learn from\n");
    else if (guide.outcome == GuideOutcome::would_not_pay)
        std::printf(
            "guide              none: it would not pay (gain %.2g after %.3g samples per pixel, %.2f s "
            "of CPU)\n",
            guide.gain, guide.samples, guide.cpu_seconds);
    if (renderer.description().integrator.manifold_sampling) print_casters(renderer.scene());
    for (const EnvironmentSampler& map : renderer.scene().light_tables.environments)
        std::printf("environment        %s\n", map.description().c_str());
    for (const PortalSampler& map : renderer.scene().light_tables.portals)
        std::printf("environment        %s\n", map.description().c_str());
}

void print_choice(const ChosenIntegrator& chosen) {
    const IntegratorChoice& choice = chosen.state.report.choice;
    std::string text = choice_text(choice);
    if (choice.seconds_to_target > 0)
        text += "; about " + duration_text(choice.seconds_to_target) + " to the target";
    std::fprintf(stderr, "montelux: integrator %s\n", text.c_str());
    for (const std::string& refusal : chosen.refusals)
        std::fprintf(stderr, "montelux: not a candidate: %s\n", refusal.c_str());
}

void print_resume_notices(const RenderSession& session, bool quiet) {
    const std::string file = session.settings().checkpoint.string();
    if (!session.refused_checkpoint().empty())
        std::fprintf(stderr, "montelux: warning: resuming from the checkpoint before the last: %s\n",
                     session.refused_checkpoint().c_str());
    if (quiet) return;
    if (session.settings().resume && !session.resumed())
        std::fprintf(stderr, "montelux: %s is not there yet: rendering from the start\n", file.c_str());
    const std::uint32_t spp = session.description().sampler.spp;
    if (session.settings().target.slice.count == 1 && session.samples_before() > spp)
        std::fprintf(stderr, "montelux: %s has %.7g samples per pixel already, more than the requested %u\n",
                     file.c_str(), session.samples_before(), spp);
}

void print_nothing_left(const RenderSession& session, const RenderReport& report) {
    const RenderTarget& target = session.settings().target;
    std::string reason, more;
    switch (report.stop) {
    case RenderStop::error:
        reason = "the target error is reached already";
        more = "a smaller --target-error";
        break;
    case RenderStop::time:
        reason = "its " + duration_text(target.time) + " are used up, since times of resumed runs add up";
        more = "a longer --time";
        break;
    case RenderStop::samples:
        if (session.samples_before() > session.description().sampler.spp) return; // said when it began
        reason = "all its samples are taken already";
        more = target.error > 0 || target.time > 0 ? "a larger --max-spp" : "a larger --spp";
        break;
    default:
        return;
    }
    std::fprintf(stderr, "montelux: %s: nothing is left to render: %s; %s continues it\n",
                 session.settings().checkpoint.c_str(), reason.c_str(), more.c_str());
}

} // namespace montelux::app
