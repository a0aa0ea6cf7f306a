// Mathematical constants in double precision, with float twins where samples need them.
#pragma once

#include <numbers>

namespace montelux {

inline constexpr double pi = std::numbers::pi;
inline constexpr double inv_pi = std::numbers::inv_pi;
inline constexpr double inv_two_pi = 0.5 * std::numbers::inv_pi;
inline constexpr double inv_four_pi = 0.25 * std::numbers::inv_pi;
inline constexpr float pi_f = static_cast<float>(pi);
inline constexpr float two_pi_f = static_cast<float>(2 * pi);
inline constexpr float inv_pi_f = static_cast<float>(inv_pi);
inline constexpr float inv_two_pi_f = static_cast<float>(inv_two_pi);
inline constexpr float inv_four_pi_f = static_cast<float>(inv_four_pi);

// Largest float below 1: canonical uniform variables lie in [0, one_minus_epsilon].
inline constexpr float one_minus_epsilon = 0x1.fffffep-1f;
inline constexpr double one_minus_epsilon_d = 0x1.fffffffffffffp-1;

} // namespace montelux
