// An integration whose evaluations the ranks of an MPI job share; in one process where there is no job.
#pragma once

#include "app/integrate/integrate_options.h"
#include <functional>
#include <memory>

#include "montelux/cluster/shared_integrand.h"

namespace montelux::app {

class SharedIntegration {
  public:
    // Joins the job. Ranks other than 0 evaluate until the integration has ended. `alone`: rank 0 does
    // everything.
    SharedIntegration(const IntegrationTask& task, bool alone);

    // Whether this rank only evaluated for rank 0; it then has nothing else to do.
    bool helped() const { return helped_; }
    // Calls work(integrand, options) with an integrand that the job evaluates, and with the task's options
    // but for the number of threads.
    using Work = std::function<void(const Integrand&, const IntegrationOptions&)>;
    void integrate(const IntegrationTask& task, const BatchFunction& f, const Work& work);

  private:
    bool helped_ = false;
    std::unique_ptr<SharedIntegrand> shared_;
};

} // namespace montelux::app
