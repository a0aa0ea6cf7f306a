#include "montelux/mc/integrate/integration_request.h"

#include <cmath>
#include <sstream>

#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

void check_error(const char* what, double error) {
    if (error >= 0 && std::isfinite(error)) return;
    std::ostringstream text;
    text << "the " << what << " error asked for is " << error
         << "; expected a finite number that is not negative";
    throw Error("integrate", text.str());
}

} // namespace

void check_request(const Budget& budget, const IntegrationOptions& options) {
    check_error("relative", budget.relative_error);
    check_error("absolute", budget.absolute_error);
    if (!(budget.time.count() >= 0)) throw Error("integrate", "expected a time that is not negative");
    if (options.threads < 0) throw Error("integrate", "expected a number of threads that is not negative");
    if (options.resume && options.checkpoint.empty())
        throw Error("integrate", "resume was asked for without a checkpoint file to resume from");
}

} // namespace montelux
