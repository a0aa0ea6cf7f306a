#include "montelux/scene/light/visible_mean.h"

namespace montelux {

double visible_mean(const Spectrum& s) {
    double sum = 0;
    int n = 0;
    for (float lambda = lambda_min; lambda <= lambda_max; lambda += 5, ++n) sum += double(s(lambda));
    return sum / n;
}

} // namespace montelux
