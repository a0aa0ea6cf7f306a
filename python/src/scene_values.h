// Attributes of scenes: conversion of numbers, vectors, spectra and textures from and to Python.
#pragma once

#include "python/src/names.h"
#include "python/src/numpy_bridge.h"
#include "python/src/scene_slots.h"
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <nanobind/nanobind.h>
#include <string>
#include <string_view>

#include "montelux/scene/texture/texture.h"
#include "montelux/spectrum/spectrum.h"

namespace montelux::python {

// A texture of a scene.
struct SpectrumTextureHandle {
    std::shared_ptr<SceneHolder> scene;
    Index index;
};
struct FloatTextureHandle {
    std::shared_ptr<SceneHolder> scene;
    Index index;
};

struct NormalMapHandle {
    std::shared_ptr<SceneHolder> scene;
    Index index;
};
struct MeasuredBrdfHandle {
    std::shared_ptr<SceneHolder> scene;
    Index index;
};

// All errors begin with `what`.
double number_of(nb::handle v, const std::string& what);
// Exactly n finite numbers.
std::vector<double> numbers_of(nb::handle v, std::size_t n, const std::string& what);
bool boolean_of(nb::handle v, const std::string& what);
std::int64_t whole_number_of(nb::handle v, std::int64_t least, std::int64_t most, const std::string& what);
// A Spectrum; a number; three numbers R, G, B; or the name of a measured one.
Spectrum spectrum_of(nb::handle v, RgbMeaning meaning, const std::string& what);
// The same or a texture, which must belong to the slot's scene.
template <typename V>
SpectrumParameter spectrum_parameter_of(nb::handle v, RgbMeaning meaning, Slot<V>& slot,
                                        const std::string& what);
template <typename V>
FloatParameter float_parameter_of(nb::handle v, Slot<V>& slot, const std::string& what);
// A matrix of shape (4, 4), points as columns.
Transform transform_of(nb::handle v, const std::string& what);
DoubleArray matrix_array(const Transform& t);
DoubleArray vector_array(Vec3f v);
// The scene whose textures a value refers to.
template <typename V>
const std::shared_ptr<SceneHolder>& scene_of_textures(const Slot<V>& slot) {
    return slot.scene() ? slot.scene() : slot.textures_of;
}
template <typename V>
nb::object spectrum_or_texture(const SpectrumParameter& p, const Slot<V>& slot) {
    if (p.is_constant()) return nb::cast(spectrum_of(p.value, slot.spectra()));
    return nb::cast(SpectrumTextureHandle{scene_of_textures(slot), p.texture});
}
nb::object number_or_texture(const FloatParameter& p, const std::shared_ptr<SceneHolder>& scene);

// 1 over the luminance of a light's spectrum: the factor of its scale by which an RGB colour of (1, 1, 1), or
// any other spectrum, gives 1 in the film's units. 0 for black.
float photometric_scale(const Spectrum& s, const std::string& what);

// Binds a detached value to the scene of a texture, or checks that a slot belongs to that scene.
template <typename V>
void require_scene(Slot<V>& slot, const std::shared_ptr<SceneHolder>& textures, const std::string& what) {
    const std::shared_ptr<SceneHolder>& at = scene_of_textures(slot);
    if (at && at != textures) throw Error(what, "the texture belongs to another scene");
    if (!slot.scene()) slot.textures_of = textures;
}

template <typename V>
SpectrumParameter spectrum_parameter_of(nb::handle v, RgbMeaning meaning, Slot<V>& slot,
                                        const std::string& what) {
    if (nb::isinstance<SpectrumTextureHandle>(v)) {
        const auto& texture = nb::cast<const SpectrumTextureHandle&>(v);
        require_scene(slot, texture.scene, what);
        return {{}, texture.index};
    }
    return {slot.add_spectrum(spectrum_of(v, meaning, what))};
}
template <typename V>
FloatParameter float_parameter_of(nb::handle v, Slot<V>& slot, const std::string& what) {
    if (nb::isinstance<FloatTextureHandle>(v)) {
        const auto& texture = nb::cast<const FloatTextureHandle&>(v);
        require_scene(slot, texture.scene, what);
        return {0, texture.index};
    }
    return {static_cast<float>(number_of(v, what))};
}

// An attribute of T with getter get(value, ref) and setter set(value, given, ref, what); `type` is for the
// stubs.
template <typename T, typename Get, typename Set>
void attribute(nb::class_<Ref<T>>& c, const char* name, const char* type, Get get, Set set, const char* doc) {
    const std::string getter = "def " + std::string(name) + "(self, /) -> " + type;
    const std::string setter = "def " + std::string(name) + "(self, value: " + type + ", /) -> None";
    const std::string what = nb::cast<std::string>(c.attr("__name__")) + "." + name;
    c.def_prop_rw(
        name, [get](const Ref<T>& r) -> nb::object { return get(r.value(), r); },
        [set, what](Ref<T>& r, nb::object given) {
            T changed = r.value();
            set(changed, given, r, what);
            r.change([&](T& value) { value = std::move(changed); });
        },
        nb::for_getter(nb::sig(getter.c_str())), nb::for_setter(nb::sig(setter.c_str())),
        nb::for_setter(nb::arg("value").none()), doc);
}

// A number; `valid` checks it, `expected` describes the valid ones.
template <typename T, typename M, typename Valid>
void number(nb::class_<Ref<T>>& c, const char* name, M T::*member, Valid valid, const char* expected,
            const char* doc) {
    attribute<T>(
        c, name, "float",
        [member](const T& t, const auto&) { return nb::float_(static_cast<double>(t.*member)); },
        [member, valid, expected](T& t, nb::handle v, auto&, const std::string& what) {
            const double x = number_of(v, what);
            if (!valid(x))
                throw Error(what, std::string(nb::repr(v).c_str()) + " was given; expected " + expected);
            t.*member = static_cast<M>(x);
        },
        doc);
}
inline bool positive(double x) { return x > 0 && std::isfinite(x); }
inline bool not_negative(double x) { return x >= 0 && std::isfinite(x); }
inline bool finite(double x) { return std::isfinite(x); }

template <typename T>
void flag(nb::class_<Ref<T>>& c, const char* name, bool T::*member, const char* doc) {
    attribute<T>(
        c, name, "bool", [member](const T& t, const auto&) { return nb::bool_(t.*member); },
        [member](T& t, nb::handle v, auto&, const std::string& what) { t.*member = boolean_of(v, what); },
        doc);
}

// A name of a table of Names; `member` is a pointer to a member, or a function that returns a reference to one.
template <typename T, typename Member, typename Table>
void choice(nb::class_<Ref<T>>& c, const char* name, Member member, const Table& table, const char* doc) {
    attribute<T>(
        c, name, "str",
        [member, &table](const T& t, const auto&) {
            const std::string_view text = table.name(std::invoke(member, t));
            return nb::str(text.data(), text.size());
        },
        [member, &table](T& t, nb::handle v, auto&, const std::string& what) {
            if (!nb::isinstance<nb::str>(v))
                throw Error(what, std::string(nb::repr(v).c_str()) + " was given; expected a name");
            std::invoke(member, t) = table.value(nb::cast<std::string>(v));
        },
        doc);
}

// An attribute with a part that may be absent: None, or a value of the class of T, which is called `type`.
template <typename T, typename Part>
void optional_part(nb::class_<Ref<T>>& c, const char* name, std::optional<Part> T::*member, const char* type,
                   const char* doc) {
    const std::string getter = "def " + std::string(name) + "(self, /) -> " + type + " | None";
    const std::string setter = "def " + std::string(name) + "(self, value: " + type + " | None, /) -> None";
    const std::string what = nb::cast<std::string>(c.attr("__name__")) + "." + name;
    c.def_prop_rw(
        name,
        [member, what](const Ref<T>& r) -> nb::object {
            if (!(r.value().*member)) return nb::none();
            const auto part = [member, what](T& value) -> Part& { return present(value.*member, what); };
            return nb::cast(
                Ref<Part>(Slot<Part>(static_cast<const Slot<Kind<T>>&>(r), std::function<Part&(T&)>(part))));
        },
        [member, what, type = std::string(type)](Ref<T>& r, const nb::object& given) {
            std::optional<Part> part;
            if (nb::isinstance<Ref<Part>>(given))
                part = nb::cast<const Ref<Part>&>(given).value();
            else if (!given.is_none())
                throw Error(what, std::string(nb::repr(given).c_str()) + " was given; expected None, or " +
                                      type + "()");
            r.change([&](T& value) { value.*member = part; });
        },
        nb::for_getter(nb::sig(getter.c_str())), nb::for_setter(nb::sig(setter.c_str())),
        nb::for_setter(nb::arg("value").none()), doc);
}

// Common to all classes of values: a constructor and comparison of slots.
template <typename T>
nb::class_<Ref<T>> value_class(nb::handle m, const char* name, const char* doc) {
    nb::class_<Ref<T>> c(m, name, doc);
    // Attributes as keyword arguments.
    c.def("__init__", [](Ref<T>* self, const nb::kwargs& attributes) {
        nb::object made = nb::cast(Ref<T>());
        if (attributes.size() > 0) nb::module_::import_("montelux._scene").attr("assign")(made, attributes);
        new (self) Ref<T>(nb::cast<const Ref<T>&>(made));
    });
    c.def(
        "__eq__",
        [](const Ref<T>& a, nb::handle b) {
            return nb::isinstance<Ref<T>>(b) && a.same_place(nb::cast<const Ref<T>&>(b));
        },
        nb::arg("other").none());
    c.def("__hash__", [](const Ref<T>& a) {
        return static_cast<std::int64_t>(reinterpret_cast<std::uintptr_t>(a.scene().get()) / 16 + a.first());
    });
    return c;
}

} // namespace montelux::python
