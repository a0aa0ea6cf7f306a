#include <utility>

#include "montelux/mc/device/device_function.h"
#include "montelux/mc/integrate/integrand.h"

namespace montelux {

Integrand Integrand::compiled(std::shared_ptr<const DeviceFunction> f) {
    Integrand integrand(f->components(), [f](const PointBatch& x, ValueBatch y) {
        f->at(x.data(), x.count(), x.stride(), y.component(0).data(), y.stride());
    });
    integrand.dimensions_ = f->dimensions();
    integrand.on_device_.function = std::move(f);
    return integrand;
}

} // namespace montelux
