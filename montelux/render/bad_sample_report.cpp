#include "montelux/render/bad_sample_report.h"

#include <tuple>

namespace montelux {

void BadSampleReport::add(const BadSample& bad) {
    BadSampleReport one;
    switch (bad.kind) {
    case BadSample::Kind::nan:
        one.nan = 1;
        break;
    case BadSample::Kind::infinite:
        one.infinite = 1;
        break;
    case BadSample::Kind::negative:
        one.negative = 1;
        break;
    }
    one.first = bad;
    merge(one);
}

void BadSampleReport::merge(const BadSampleReport& other) {
    nan += other.nan;
    infinite += other.infinite;
    negative += other.negative;
    auto key = [](const BadSample& b) { return std::tuple(b.sample, b.y, b.x); };
    if (other.first && (!first || key(*other.first) < key(*first))) first = other.first;
}

} // namespace montelux
