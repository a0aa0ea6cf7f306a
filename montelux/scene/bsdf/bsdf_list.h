// Bsdf: the variant of all BSDFs of surfaces, by name: enough for a declaration. bsdf.h has their definitions.
#pragma once

#include <variant>

#include "montelux/mc/math/number.h"

namespace montelux {

struct Ggx;
struct MicrofacetNormals;
struct DisneySolid;
struct DisneySheet;

template <Number T>
struct DiffuseBsdfOf;
template <typename Normals>
struct ConductorBsdfOf;
template <typename Normals>
struct DielectricBsdfOf;
template <typename Interface>
struct TintedBsdf;
template <typename Lobes, bool may_transmit>
struct DisneyBsdf;
template <bool may_transmit>
struct PrincipledBsdf;

using DiffuseBsdf = DiffuseBsdfOf<float>;
using ConductorBsdf = ConductorBsdfOf<Ggx>;
using DielectricBsdf = DielectricBsdfOf<Ggx>;
struct DiffuseTransmissionBsdf;
struct ThinDielectricBsdf;
struct CoatedDiffuseBsdf;
struct HairBsdf;
struct MeasuredBsdf;
struct SubsurfaceBsdf;
struct MultiscatterConductorBsdf;
struct MultiscatterDielectricBsdf;
struct PlasticBsdf;
using TintedConductorBsdf = TintedBsdf<ConductorBsdfOf<MicrofacetNormals>>;
using TintedDielectricBsdf = TintedBsdf<DielectricBsdfOf<MicrofacetNormals>>;
using TintedThinDielectricBsdf = TintedBsdf<ThinDielectricBsdf>;
using DisneySolidBsdf = DisneyBsdf<DisneySolid, true>;
using DisneyOpaqueBsdf = DisneyBsdf<DisneySolid, false>;
using DisneySheetBsdf = DisneyBsdf<DisneySheet, true>;

template <typename Base, typename Coat = DielectricBsdf>
struct LayeredBsdf;

// All BSDFs of materials, and Others.
template <typename... Others>
using BsdfVariant =
    std::variant<DiffuseBsdf, DiffuseTransmissionBsdf, ConductorBsdf, DielectricBsdf, ThinDielectricBsdf,
                 CoatedDiffuseBsdf, LayeredBsdf<DiffuseBsdf>, LayeredBsdf<ConductorBsdf>, HairBsdf,
                 MeasuredBsdf, SubsurfaceBsdf, MultiscatterConductorBsdf, MultiscatterDielectricBsdf,
                 LayeredBsdf<DiffuseBsdf, MultiscatterDielectricBsdf>,
                 LayeredBsdf<MultiscatterConductorBsdf, MultiscatterDielectricBsdf>, PrincipledBsdf<false>,
                 PrincipledBsdf<true>, TintedConductorBsdf, TintedDielectricBsdf, TintedThinDielectricBsdf,
                 PlasticBsdf, DisneySolidBsdf, DisneyOpaqueBsdf, DisneySheetBsdf, Others...>;
using UntiltedBsdf = BsdfVariant<>;
struct TiltedBsdf;
using Bsdf = BsdfVariant<TiltedBsdf>;

} // namespace montelux
