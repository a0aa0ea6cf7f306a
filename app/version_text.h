// What --version prints: the version, what it was built for, and the libraries it uses.
#pragma once

#include <string>

namespace montelux::app {

std::string version_text();

} // namespace montelux::app
