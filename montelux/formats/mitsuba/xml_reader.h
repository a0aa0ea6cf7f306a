// read_xml: the elements of an XML file, one after the other, each with its place.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string_view>
#include <vector>

#include "montelux/formats/mitsuba/xml_values.h"
#include "montelux/formats/text_diagnostics.h"

namespace montelux::mitsuba {

// What a reader does with the elements; both may throw.
struct XmlHandler {
    std::function<void(std::string_view element, std::vector<Attribute> attributes, SourceLocation at)> begin;
    std::function<void()> end; // of the element that began last and has not ended
};

// `file`: of the diagnostics. Text between elements is ignored. Throws Error for text that is no XML, elements nested
// deeper than 100, and declarations of entities, whose expansion could fill the memory.
void read_xml(std::span<const std::uint8_t> bytes, std::uint32_t file, const TextDiagnostics& diagnostics,
              const XmlHandler& handler);

} // namespace montelux::mitsuba
