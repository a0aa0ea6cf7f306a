// Draws of Markov chains as a netCDF-4 file with a group `posterior`, which arviz.from_netcdf reads.
#pragma once

#include <string>
#include <vector>

#include "montelux/mc/integrate/chains/sample_chains.h"

namespace montelux::app {

// Names the file of libnetcdf, where the system does not find it.
inline constexpr const char* netcdf_library_variable = "MONTELUX_NETCDF_LIBRARY";

// Throws Error where libnetcdf, which is loaded while the program runs, cannot be.
void check_netcdf();

// Dimensions `chain` and `draw` with their numbers as coordinates, and each variable over both. The file appears
// complete or not at all; "" is the standard output.
void write_netcdf(const std::string& path, const std::vector<std::string>& names, const ChainDraws& draws);

} // namespace montelux::app
