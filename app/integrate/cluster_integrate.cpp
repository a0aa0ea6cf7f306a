#include "app/integrate/cluster_integrate.h"

#include "app/cluster_job.h"
#include "app/commands.h"
#include "app/interrupt.h"
#include <cstdio>
#include <exception>

#include "montelux/cluster/communicator.h"
#include "montelux/mc/math/error.h"

namespace montelux::app {
namespace {

// Without waiting for the ranks that do not answer.
[[noreturn]] void end_job_with(const std::exception& e) {
    std::fprintf(stderr, "montelux: error: %s\n", e.what());
    end_job(exit_failed);
}

} // namespace

SharedIntegration::SharedIntegration(const IntegrationTask& task, bool alone) {
    if (alone) {
        helped_ = is_silent_rank();
        return;
    }
    Communicator* const job = join_job(patience_with_ranks);
    if (job == nullptr) return;
    const int fair = job->fair_threads();
    const int threads = task.options.threads > 0 ? task.options.threads : fair;
    const int components = task.integrand.count();
    if (job->rank() == 0) {
        try {
            shared_ = std::make_unique<SharedIntegrand>(*job, task.integrand.function, components, threads,
                                                        patience_with_ranks);
        } catch (const Error& e) { // a rank never came
            end_job_with(e);
        }
        return;
    }
    helped_ = true;
    try {
        serve_integrand(*job, task.integrand.function, components, threads, &follow_on_signals(),
                        patience_with_leader);
    } catch (const std::exception& e) {
        print_rank_error(e.what());
        end_job(exit_failed);
    }
}

void SharedIntegration::integrate(const IntegrationTask& task, const BatchFunction& f, const Work& work) {
    if (!shared_) return work(task.integrand.integrand(f), task.options);

    IntegrationOptions options = task.options;
    options.threads = shared_->threads();
    try {
        shared_->lead(
            [&] {
                auto shared = [this](const PointBatch& x, ValueBatch y) { (*shared_)(x, y); };
                work(task.integrand.integrand(shared), options);
            },
            request_cancel);
    } catch (const std::exception& e) {
        if (!shared_->failed()) throw;
        end_job_with(e);
    }
    shared_.reset();
}

} // namespace montelux::app
