#include "montelux/formats/measured_brdf_file.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <string_view>
#include <utility>
#include <vector>

#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

constexpr std::string_view tensor_file_magic("tensor_file\0", 12);
enum : std::uint8_t { tensor_of_uint8 = 1, tensor_of_float32 = 10 };

struct TensorField {
    std::uint8_t type = 0;
    std::vector<std::uint64_t> shape; // the last index varies fastest
    std::span<const std::uint8_t> bytes;
};

// A file begins with its magic, two bytes of its version and the number of fields. A field has a name, a type, an
// offset from the beginning of the file and a shape. Numbers are little-endian.
class TensorFile {
  public:
    TensorFile(std::span<const std::uint8_t> bytes, const std::string& name) : rest_(bytes), name_(name) {
        if (bytes.size() < tensor_file_magic.size() ||
            !std::equal(tensor_file_magic.begin(), tensor_file_magic.end(), bytes.begin()))
            throw Error(name_, "is no file of a measured BRDF (.bsdf)");
        rest_ = rest_.subspan(tensor_file_magic.size());
        if (const auto version = take<std::array<std::uint8_t, 2>>(); version[0] != 1)
            throw Error(name_, "has version " + std::to_string(version[0]) + " of the format; expected 1");
        const auto count = take<std::uint32_t>();
        for (std::uint32_t i = 0; i < count; ++i) {
            const std::span<const std::uint8_t> field_name = take_bytes(take<std::uint16_t>());
            const auto dimensions = take<std::uint16_t>();
            TensorField field;
            field.type = take<std::uint8_t>();
            const auto offset = take<std::uint64_t>();
            std::uint64_t size = 1;
            for (std::uint16_t d = 0; d < dimensions; ++d) {
                field.shape.push_back(take<std::uint64_t>());
                // Beyond the size of the file there is no need to know it.
                size = field.shape.back() > bytes.size()
                           ? bytes.size() + 1
                           : std::min(size * field.shape.back(), bytes.size() + 1);
            }
            if (field.type == tensor_of_float32) size *= sizeof(float);
            if (field.type == tensor_of_uint8 || field.type == tensor_of_float32) {
                if (offset > bytes.size() || size > bytes.size() - offset) throw Error(name_, "ends early");
                field.bytes = bytes.subspan(offset, size);
            }
            fields_.emplace(std::string(field_name.begin(), field_name.end()), std::move(field));
        }
    }

    const TensorField& field(const std::string& name, std::uint8_t type, std::size_t dimensions) const {
        const auto found = fields_.find(name);
        if (found == fields_.end()) throw Error(name_, "has no field '" + name + "'");
        if (found->second.type != type || found->second.shape.size() != dimensions)
            throw Error(name_,
                        "field '" + name + "' has another type or number of dimensions than a measured BRDF");
        return found->second;
    }
    std::vector<float> numbers(const std::string& name, std::size_t dimensions) const {
        const TensorField& f = field(name, tensor_of_float32, dimensions);
        std::vector<float> values(f.bytes.size() / sizeof(float));
        if (!values.empty()) std::memcpy(values.data(), f.bytes.data(), f.bytes.size());
        return values;
    }
    // The last two indices are row and column of a table; `counts` are those before.
    BrdfTables tables(const std::string& name, const std::vector<std::uint64_t>& counts) const {
        const TensorField& f = field(name, tensor_of_float32, counts.size() + 2);
        const std::uint64_t rows = f.shape[counts.size()], columns = f.shape[counts.size() + 1];
        if (!std::equal(counts.begin(), counts.end(), f.shape.begin()) || rows > 65536 || columns > 65536)
            throw Error(name_, "field '" + name + "' has a size that does not fit the other fields");
        return {static_cast<std::uint32_t>(columns), static_cast<std::uint32_t>(rows),
                numbers(name, counts.size() + 2)};
    }

  private:
    std::span<const std::uint8_t> take_bytes(std::size_t count) {
        if (count > rest_.size()) throw Error(name_, "ends early");
        const std::span<const std::uint8_t> taken = rest_.first(count);
        rest_ = rest_.subspan(count);
        return taken;
    }
    template <typename T>
    T take() {
        T value;
        std::memcpy(&value, take_bytes(sizeof value).data(), sizeof value);
        return value;
    }

    std::span<const std::uint8_t> rest_;
    std::string name_;
    std::map<std::string, TensorField> fields_;
};

} // namespace

MeasuredBrdf read_measured_brdf(std::span<const std::uint8_t> bytes, const std::string& name) {
    const TensorFile file(bytes, name);
    // Densities of normals are those over directions; other files would be a different model.
    if (const TensorField& jacobian = file.field("jacobian", tensor_of_uint8, 1); jacobian.bytes.size() != 1)
        throw Error(name, "field 'jacobian' has a size that does not fit the other fields");
    MeasuredBrdfData d;
    d.theta = file.numbers("theta_i", 1);
    d.phi = file.numbers("phi_i", 1);
    d.wavelengths = file.numbers("wavelengths", 1);
    const std::uint64_t thetas = d.theta.size(), phis = d.phi.size(), lambdas = d.wavelengths.size();
    d.ndf = file.tables("ndf", {});
    d.sigma = file.tables("sigma", {});
    d.visible_normals = file.tables("vndf", {phis, thetas});
    d.luminance = file.tables("luminance", {phis, thetas});
    d.spectra = file.tables("spectra", {phis, thetas, lambdas});
    try {
        return MeasuredBrdf(std::move(d));
    } catch (const Error& e) {
        throw Error(name, e.what());
    }
}

void write_measured_brdf(AtomicFile& file, const MeasuredBrdf& brdf) {
    const MeasuredBrdfData& d = brdf.data();
    struct Field {
        std::string_view name;
        std::vector<std::uint64_t> shape;
        std::span<const float> values;
        bool is_flag = false;
    };
    const std::uint64_t thetas = d.theta.size(), phis = d.phi.size(), lambdas = d.wavelengths.size();
    const auto tables = [](std::string_view name, std::vector<std::uint64_t> counts, const BrdfTables& t) {
        counts.push_back(t.rows);
        counts.push_back(t.columns);
        return Field{name, std::move(counts), t.values};
    };
    const std::array<Field, 9> fields = {Field{"theta_i", {thetas}, d.theta},
                                         Field{"phi_i", {phis}, d.phi},
                                         Field{"wavelengths", {lambdas}, d.wavelengths},
                                         tables("ndf", {}, d.ndf),
                                         tables("sigma", {}, d.sigma),
                                         tables("vndf", {phis, thetas}, d.visible_normals),
                                         tables("luminance", {phis, thetas}, d.luminance),
                                         tables("spectra", {phis, thetas, lambdas}, d.spectra),
                                         Field{"jacobian", {1}, {}, true}};
    std::uint64_t offset = tensor_file_magic.size() + 2 + sizeof(std::uint32_t);
    for (const Field& f : fields) offset += 2 + f.name.size() + 2 + 1 + 8 + 8 * f.shape.size();
    const auto put = [&](const auto& value) { file.write(&value, sizeof value); };
    file.write(tensor_file_magic.data(), tensor_file_magic.size());
    put(std::array<std::uint8_t, 2>{1, 0});
    put(static_cast<std::uint32_t>(fields.size()));
    for (const Field& f : fields) {
        put(static_cast<std::uint16_t>(f.name.size()));
        file.write(f.name.data(), f.name.size());
        put(static_cast<std::uint16_t>(f.shape.size()));
        put(static_cast<std::uint8_t>(f.is_flag ? tensor_of_uint8 : tensor_of_float32));
        put(offset);
        for (const std::uint64_t n : f.shape) put(n);
        offset += f.is_flag ? 1 : f.values.size_bytes();
    }
    for (const Field& f : fields)
        if (f.is_flag)
            put(std::uint8_t{1});
        else
            file.write(f.values.data(), f.values.size_bytes());
}

} // namespace montelux
