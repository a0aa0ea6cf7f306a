// Material: the variant of all materials, one file per kind; all satisfy MaterialModel (material_model.cpp).
#pragma once

#include <type_traits>
#include <variant>

#include "montelux/scene/material/coated_conductor_material.h"
#include "montelux/scene/material/coated_diffuse_material.h"
#include "montelux/scene/material/conductor_material.h"
#include "montelux/scene/material/dielectric_material.h"
#include "montelux/scene/material/diffuse_material.h"
#include "montelux/scene/material/diffuse_transmission_material.h"
#include "montelux/scene/material/disney_material.h"
#include "montelux/scene/material/hair_material.h"
#include "montelux/scene/material/interface_material.h"
#include "montelux/scene/material/measured_material.h"
#include "montelux/scene/material/mix_material.h"
#include "montelux/scene/material/plastic_material.h"
#include "montelux/scene/material/principled_material.h"
#include "montelux/scene/material/sided_material.h"
#include "montelux/scene/material/subsurface_material.h"
#include "montelux/scene/material/thin_dielectric_material.h"

namespace montelux {

using Material =
    std::variant<DiffuseMaterial, ConductorMaterial, DielectricMaterial, ThinDielectricMaterial,
                 CoatedDiffuseMaterial, CoatedConductorMaterial, DiffuseTransmissionMaterial,
                 InterfaceMaterial, MixMaterial, HairMaterial, MeasuredMaterial, SubsurfaceMaterial,
                 PrincipledMaterial, PlasticMaterial, SidedMaterial, DisneyMaterial, DisneyThinMaterial>;
static_assert(std::is_trivially_copyable_v<Material>);

} // namespace montelux
