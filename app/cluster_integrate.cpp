#include "app/cluster_integrate.h"

#include "app/cluster_job.h"
#include "app/interrupt.h"
#include <cstdio>
#include <exception>

#include "montelux/mc/integrate/integrate.h"

namespace montelux::app {
SharedIntegration::SharedIntegration(const IntegrationTask& task, bool alone) {
    if (alone) {
        helped_ = is_silent_rank();
        return;
    }
    job_ = join_job();
    if (!job_) return;
    const int fair = job_->fair_threads();
    const int threads = task.options.threads > 0 ? task.options.threads : fair;
    const int components = task.formulas.count();
    if (job_->rank() == 0) {
        shared_ = std::make_unique<SharedIntegrand>(*job_, task.formulas, components, threads);
        return;
    }
    helped_ = true;
    try {
        serve_integrand(*job_, task.formulas, components, threads, &follow_on_signals(),
                        patience_with_leader);
    } catch (const std::exception& e) {
        speak_up(e.what());
        job_->abort(1);
    }
}

IntegrationResult SharedIntegration::integrate(const IntegrationTask& task, const BatchFunction& f) {
    const int components = task.formulas.count();
    auto integrated = [&](const Integrand& integrand, const IntegrationOptions& options) {
        return montelux::integrate(integrand, task.domain, task.method, task.budget, options);
    };
    if (!shared_) return integrated(Integrand::batch(f, components), task.options);

    IntegrationOptions options = task.options;
    options.threads = shared_->threads();
    IntegrationResult result;
    try {
        shared_->lead(
            [&] {
                auto shared = [this](const PointBatch& x, ValueBatch y) { (*shared_)(x, y); };
                result = integrated(Integrand::batch(shared, components), options);
            },
            request_cancel);
    } catch (const std::exception& e) {
        if (!shared_->failed()) throw;
        std::fprintf(stderr, "montelux: error: %s\n", e.what());
        std::fflush(nullptr);
        job_->abort(1);
    }
    shared_.reset();
    return result;
}

} // namespace montelux::app
