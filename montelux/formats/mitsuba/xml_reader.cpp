#include "montelux/formats/mitsuba/xml_reader.h"

#include <algorithm>
#include <exception>
#include <expat.h>
#include <limits>
#include <memory>
#include <string>
#include <utility>

#include "montelux/mc/math/error.h"

namespace montelux::mitsuba {
namespace {

constexpr int max_nesting = 100;

// Errors must not pass through the parser, which is written in C: they are kept until it has returned.
struct Run {
    XML_Parser parser;
    std::uint32_t file;
    const TextDiagnostics& diagnostics;
    const XmlHandler& handler;
    std::exception_ptr failure{};
    int depth = 0;

    SourceLocation here() const {
        const auto limited = [](XML_Size n) {
            return static_cast<std::uint32_t>(
                std::min<XML_Size>(n, std::numeric_limits<std::uint32_t>::max() - 1) + 1);
        };
        return {file, static_cast<std::uint32_t>(XML_GetCurrentLineNumber(parser)),
                limited(XML_GetCurrentColumnNumber(parser))};
    }
    template <typename Action>
    void guarded(Action&& action) noexcept {
        if (failure) return;
        try {
            action();
        } catch (...) {
            failure = std::current_exception();
            XML_StopParser(parser, XML_FALSE);
        }
    }
};

void XMLCALL begin_element(void* data, const XML_Char* name, const XML_Char** attributes) {
    Run& run = *static_cast<Run*>(data);
    run.guarded([&] {
        if (++run.depth > max_nesting)
            run.diagnostics.error(run.here(),
                                  "elements are nested deeper than " + std::to_string(max_nesting));
        std::vector<Attribute> all;
        for (; *attributes != nullptr; attributes += 2) all.push_back({attributes[0], attributes[1]});
        run.handler.begin(name, std::move(all), run.here());
    });
}

void XMLCALL end_element(void* data, const XML_Char*) {
    Run& run = *static_cast<Run*>(data);
    run.guarded([&] {
        --run.depth;
        run.handler.end();
    });
}

void XMLCALL declare_entity(void* data, const XML_Char*, int, const XML_Char*, int, const XML_Char*,
                            const XML_Char*, const XML_Char*, const XML_Char*) {
    Run& run = *static_cast<Run*>(data);
    run.guarded(
        [&] { run.diagnostics.error(run.here(), "entities are not read: write what they stand for"); });
}

} // namespace

void read_xml(std::span<const std::uint8_t> bytes, std::uint32_t file, const TextDiagnostics& diagnostics,
              const XmlHandler& handler) {
    const std::unique_ptr<XML_ParserStruct, decltype(&XML_ParserFree)> parser(XML_ParserCreate(nullptr),
                                                                              &XML_ParserFree);
    if (!parser) throw std::bad_alloc();
    Run run{parser.get(), file, diagnostics, handler};
    XML_SetUserData(parser.get(), &run);
    XML_SetElementHandler(parser.get(), begin_element, end_element);
    XML_SetEntityDeclHandler(parser.get(), declare_entity);
    constexpr std::size_t block = std::size_t{1} << 20;
    for (;;) {
        const std::size_t size = std::min(bytes.size(), block);
        const bool last = size == bytes.size();
        const XML_Status status = XML_Parse(parser.get(), reinterpret_cast<const char*>(bytes.data()),
                                            static_cast<int>(size), last ? XML_TRUE : XML_FALSE);
        if (run.failure) std::rethrow_exception(run.failure);
        if (status == XML_STATUS_ERROR)
            diagnostics.error(run.here(), std::string("this is not XML: ") +
                                              XML_ErrorString(XML_GetErrorCode(parser.get())));
        if (last) return;
        bytes = bytes.subspan(size);
    }
}

} // namespace montelux::mitsuba
