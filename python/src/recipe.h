// What an object was made from, for pickle: python/montelux/_pickling.py reads it.
#pragma once

#include <nanobind/nanobind.h>
#include <utility>

namespace montelux::python {

namespace nb = nanobind;

// Notes the arguments of a constructor in the object's __dict__; the class needs nb::dynamic_attr().
inline void note_recipe(nb::handle self, const nb::tuple& arguments, const nb::dict& named = nb::dict()) {
    self.attr("__dict__")["_recipe"] = nb::make_tuple(nb::none(), arguments, named);
}

} // namespace montelux::python
