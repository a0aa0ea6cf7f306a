// Slot: a value of a scene as Python refers to it, inside a scene or detached.
#pragma once

#include <functional>
#include <memory>
#include <nanobind/nanobind.h>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "montelux/mc/math/error.h"
#include "montelux/scene/material/material_model.h"
#include "montelux/scene/render_settings.h"

namespace montelux::python {

namespace nb = nanobind;

// A scene that Python changes. Renders share the description; while one of them does, the next change copies
// it first.
struct SceneHolder {
    std::shared_ptr<SceneDescription> description = std::make_shared<SceneDescription>();
    bool has_camera = false;
    std::string name = "scene";
    std::vector<std::string> warnings;

    const SceneDescription& read() const { return *description; }
    SceneDescription& edit() {
        if (description.use_count() > 1) description = std::make_shared<SceneDescription>(*description);
        return *description;
    }
};

// The location of each kind of value in a scene.
inline Material& element(SceneDescription& d, Index i, std::type_identity<Material>) {
    return d.scene.materials.at(i);
}
inline Light& element(SceneDescription& d, Index i, std::type_identity<Light>) {
    return d.scene.lights.at(i);
}
inline Shape& element(SceneDescription& d, Index i, std::type_identity<Shape>) {
    return d.scene.shapes.at(i);
}
inline CameraSettings& element(SceneDescription& d, Index, std::type_identity<CameraSettings>) {
    return d.scene.camera;
}
inline FilmSettings& element(SceneDescription& d, Index, std::type_identity<FilmSettings>) { return d.film; }
inline PixelFilter& element(SceneDescription& d, Index, std::type_identity<PixelFilter>) {
    return d.film.filter;
}
inline SamplerSettings& element(SceneDescription& d, Index, std::type_identity<SamplerSettings>) {
    return d.sampler;
}
inline IntegratorSettings& element(SceneDescription& d, Index, std::type_identity<IntegratorSettings>) {
    return d.integrator;
}

// Parts that a scene may lack. Python's references to one end when it is taken away.
template <typename T>
T& present(std::optional<T>& part, const std::string& name) {
    if (!part) throw Error(name, "it was set to None after this reference to it was read");
    return *part;
}
inline SpectralSettings& element(SceneDescription& d, Index, std::type_identity<SpectralSettings>) {
    return present(d.film.spectral, "Film.spectral");
}
inline OcclusionSettings& element(SceneDescription& d, Index, std::type_identity<OcclusionSettings>) {
    return present(d.integrator.occlusion, "Integrator.occlusion");
}
inline MergingSettings& element(SceneDescription& d, Index, std::type_identity<MergingSettings>) {
    return present(d.integrator.merging, "Integrator.merging");
}

// A value in a scene, a detached one, which has its own spectra, or a part of a detached one.
template <typename V>
class Slot {
  public:
    explicit Slot(V own, std::vector<Spectrum> spectra = {})
        : own_(std::make_shared<Own>(std::move(own), std::move(spectra))) {}
    explicit Slot(std::shared_ptr<SceneHolder> scene, Index first = 0)
        : scene_(std::move(scene)), first_(first) {}
    // A part without spectra. In scenes `element` finds it; it is read and changed where it is.
    template <typename Whole>
    Slot(const Slot<Whole>& whole, std::function<V&(Whole&)> part) : scene_(whole.scene()) {
        if (scene_) return;
        detached_whole_ = whole.identity();
        part_ = [whole = Slot<Whole>(whole), part = std::move(part)]() mutable -> V& {
            V* found = nullptr;
            whole.edit([&](Whole& w) { found = &part(w); });
            return *found;
        };
    }

    const V& read() const {
        if (part_) return part_();
        return own_ ? own_->value : element(*scene_->description, first_, std::type_identity<V>());
    }
    template <typename Change>
    void edit(const Change& change) {
        if (part_) return change(part_());
        if (own_) return change(own_->value);
        change(element(scene_->edit(), first_, std::type_identity<V>()));
    }
    // The spectra that the value refers to.
    const std::vector<Spectrum>& spectra() const {
        return own_ ? own_->spectra : scene_->read().scene.spectra;
    }
    SceneSpectrum add_spectrum(const Spectrum& spectrum) {
        return montelux::add_spectrum(own_ ? own_->spectra : scene_->edit().scene.spectra, spectrum);
    }
    const std::shared_ptr<SceneHolder>& scene() const { return scene_; }
    Index first() const { return first_; }
    bool same_place(const Slot& other) const {
        return scene_ == other.scene_ && first_ == other.first_ && identity() == other.identity();
    }
    // Of a detached value, or that of which this is a part; null in a scene.
    std::shared_ptr<const void> identity() const { return part_ ? detached_whole_ : own_; }
    // The scene whose textures a detached value refers to.
    std::shared_ptr<SceneHolder> textures_of;

  private:
    struct Own {
        Own(V v, std::vector<Spectrum> s) : value(std::move(v)), spectra(std::move(s)) {}
        V value;
        std::vector<Spectrum> spectra;
    };
    std::shared_ptr<SceneHolder> scene_;
    Index first_ = 0;
    std::shared_ptr<Own> own_;
    std::function<V&()> part_;
    std::shared_ptr<const void> detached_whole_;
};

// visit(spectrum) for each SceneSpectrum of a material or light.
template <typename Visit>
void visit_spectra(Material& material, const Visit& visit) {
    visit_fields(material, [&]<typename Field>(std::string_view, Field& field) {
        if constexpr (std::is_same_v<Field, SceneSpectrum>)
            visit(field);
        else if constexpr (std::is_same_v<Field, SpectrumParameter>)
            visit(field.value);
    });
}
template <typename Visit>
void visit_spectra(Light& light, const Visit& visit) {
    std::visit(
        [&](auto& l) {
            if constexpr (requires { l.spectrum; }) visit(l.spectrum);
        },
        light);
}

// The value of a slot for a place in `scene`, to which its spectra are added where it is not of that scene.
template <typename V>
V value_for(const std::shared_ptr<SceneHolder>& scene, const Slot<V>& slot) {
    V value = slot.read();
    if (slot.scene() != scene)
        visit_spectra(value, [&](SceneSpectrum& s) {
            s = add_spectrum(scene->edit().scene, spectrum_of(s, slot.spectra()));
        });
    return value;
}

// The kind of value that an alternative T belongs to.
template <typename T>
struct KindOf {
    using type = T;
};
template <typename T, typename Variant>
inline constexpr bool is_alternative_of = false;
template <typename T, typename... Ts>
inline constexpr bool is_alternative_of<T, std::variant<Ts...>> = (std::is_same_v<T, Ts> || ...);
template <typename T>
requires is_alternative_of<T, Material>
struct KindOf<T> {
    using type = Material;
};
template <typename T>
requires is_alternative_of<T, Light>
struct KindOf<T> {
    using type = Light;
};
template <typename T>
requires is_alternative_of<T, CameraModel>
struct KindOf<T> {
    using type = CameraSettings;
};
template <typename T>
requires is_alternative_of<T, PixelFilter>
struct KindOf<T> {
    using type = PixelFilter;
};
template <typename T>
T* alternative(T& value, std::type_identity<T>) {
    return &value;
}
template <typename T, typename... Ts>
T* alternative(std::variant<Ts...>& value, std::type_identity<T>) {
    return std::get_if<T>(&value);
}
template <typename T>
T* alternative(CameraSettings& value, std::type_identity<T>) {
    return std::get_if<T>(&value.model);
}
template <typename T>
using Kind = typename KindOf<T>::type;

// Luminance 1, under the spectrum of R, G, B = 1, 1, 1.
void make_white(SceneSpectrum& spectrum, float& scale, std::vector<Spectrum>& spectra);

// Defaults of new scenes: those of a scene file. Lights are white. `spectra` receives those of the value.
template <typename T>
T default_value(std::vector<Spectrum>& spectra) {
    if constexpr (is_alternative_of<T, Material>)
        return default_material<T>([&](const Spectrum& s) { return add_spectrum(spectra, s); });
    T value{};
    if constexpr (is_alternative_of<T, Light> && requires { value.spectrum; })
        make_white(value.spectrum, value.scale, spectra);
    return value;
}
template <>
SpotLight default_value(std::vector<Spectrum>& spectra);

// A slot with the alternative T.
template <typename T>
struct Ref : Slot<Kind<T>> {
    using V = Kind<T>;
    Ref() : Slot<V>(initial()) {}
    explicit Ref(Slot<V> slot) : Slot<V>(std::move(slot)) {}

    const T& value() const { return held(const_cast<V&>(this->read())); }
    template <typename Change>
    void change(const Change& f) {
        this->edit([&](V& v) { f(held(v)); });
    }

  private:
    static Slot<V> initial() {
        std::vector<Spectrum> spectra;
        T value = default_value<T>(spectra);
        if constexpr (std::is_same_v<V, CameraSettings>)
            return Slot<V>(CameraSettings{std::move(value), {}});
        else
            return Slot<V>(V(std::move(value)), std::move(spectra));
    }
    static T& held(V& v) {
        T* found = nullptr;
        if constexpr (std::is_same_v<V, T>)
            found = &v;
        else
            found = alternative(v, std::type_identity<T>());
        if (!found) throw Error("scene", "this value has been replaced by one of another kind");
        return *found;
    }
};

template <typename V>
nb::object as_python(Slot<V> slot) {
    const auto cast = [&]<typename T>(const T&) { return nb::cast(Ref<T>(slot)); };
    if constexpr (std::is_same_v<V, CameraSettings>)
        return std::visit(cast, slot.read().model);
    else
        return std::visit(cast, slot.read());
}

// The slot of a Python object of any alternative of V; null for other objects.
template <typename V, typename Variant>
struct SlotOf;
template <typename V, typename... Ts>
struct SlotOf<V, std::variant<Ts...>> {
    static Slot<V>* of(nb::handle o) {
        Slot<V>* found = nullptr;
        ((found =
              !found && nb::isinstance<Ref<Ts>>(o) ? static_cast<Slot<V>*>(nb::cast<Ref<Ts>*>(o)) : found),
         ...);
        return found;
    }
};
inline Slot<Material>* material_slot(nb::handle o) { return SlotOf<Material, Material>::of(o); }
inline Slot<Light>* light_slot(nb::handle o) { return SlotOf<Light, Light>::of(o); }
inline Slot<CameraSettings>* camera_slot(nb::handle o) { return SlotOf<CameraSettings, CameraModel>::of(o); }
inline Slot<PixelFilter>* filter_slot(nb::handle o) { return SlotOf<PixelFilter, PixelFilter>::of(o); }

} // namespace montelux::python
