// NameTable: things of one kind that are declared and referred to by name, in any order.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "montelux/scene/build/build_messages.h"
#include "montelux/scene/index.h"

namespace montelux {

// Each name is looked up once where it is used, and once when all are known.
class NameTable {
  public:
    // `what` is what messages call such a thing: "object".
    explicit NameTable(std::string what) : what_(std::move(what)) {}

    // The thing of that name is number `index`. An error where the name is taken.
    void declare(const std::string& name, Index index, SourceLocation at, const BuildMessages& messages);

    // A reference to the name, whether it is declared yet or not. Equal for equal names.
    Index refer(const std::string& name);

    // The number of the thing that a reference means. An error, with the nearest name, where it is not
    // declared; `by` may say what refers to it: "this shape's ".
    Index resolve(Index reference, SourceLocation at, const BuildMessages& messages,
                  std::string_view by = {}) const;

  private:
    std::string what_;
    std::map<std::string, Index> declared_;
    std::map<std::string, Index> reference_of_;
    std::vector<std::string> names_; // of references
};

} // namespace montelux
