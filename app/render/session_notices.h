// Notices about a render as a whole: what it resumes from, bad samples, times.
#pragma once

#include <cstdint>

#include "montelux/render/bad_sample_report.h"
#include "montelux/render/render_session.h"

namespace montelux::app {

// Which integrator was chosen, and why.
void print_choice(const ChosenIntegrator& chosen);
void print_resume_notices(const RenderSession& session, bool quiet);
// Why a resumed render took no samples.
void print_nothing_left(const RenderSession& session, const RenderReport& report);
// `can_replay`: by --debug-sample.
void print_bad_samples(const BadSampleReport& bad, std::uint64_t seed, bool can_replay);
void print_statistics(const RenderReport& report, const OutlierReport& outliers, double load_seconds,
                      const Renderer& renderer);

} // namespace montelux::app
