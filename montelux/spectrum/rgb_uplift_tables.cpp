// Embeds the file that cmake/generators/rgb_uplift_generator.cpp writes.
#include <string>

#include "montelux/mc/math/error.h"
#include "montelux/spectrum/rgb_uplift.h"
#include "montelux/spectrum/rgb_uplift_layout.h"

#ifndef MONTELUX_RGB_UPLIFT_FILE
#error "MONTELUX_RGB_UPLIFT_FILE must name the file of tables; cmake/MonteluxUplift.cmake sets it"
#endif

asm(".pushsection .rodata\n"
    ".balign 64\n"
    ".global montelux_rgb_uplift_nodes\n"
    ".hidden montelux_rgb_uplift_nodes\n"
    "montelux_rgb_uplift_nodes:\n"
    ".incbin \"" MONTELUX_RGB_UPLIFT_FILE "\"\n"
    ".popsection\n");

extern "C" const montelux::Float4 montelux_rgb_uplift_nodes[];

namespace montelux {

namespace {

template <std::size_t I>
const RgbUpliftTable& table() {
    static const RgbUpliftTable instance = [] {
        std::size_t first = 0;
        for (std::size_t i = 0; i < I; ++i) first += rgb_uplift_layouts[i].node_count();
        return RgbUpliftTable(*find_rgb_color_space(rgb_uplift_layouts[I].space),
                              rgb_uplift_layouts[I].resolution, montelux_rgb_uplift_nodes + first);
    }();
    return instance;
}

} // namespace

const RgbUpliftTable& rgb_uplift_table(const RgbColorSpace& space) {
    if (&space == &RgbColorSpace::srgb()) return table<0>();
    if (&space == &RgbColorSpace::dci_p3()) return table<1>();
    if (&space == &RgbColorSpace::rec2020()) return table<2>();
    if (&space == &RgbColorSpace::aces2065_1()) return table<3>();
    throw Error("there is no RGB uplift table for the colour space \"" + std::string(space.name()) + "\"");
}

} // namespace montelux
