// Overloaded: several lambdas as one, for std::visit.
#pragma once

namespace montelux {

template <typename... Functions>
struct Overloaded : Functions... {
    using Functions::operator()...;
};
template <typename... Functions>
Overloaded(Functions...) -> Overloaded<Functions...>;

} // namespace montelux
