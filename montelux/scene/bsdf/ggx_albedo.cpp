#include "montelux/scene/bsdf/ggx_albedo.h"

#include "montelux/scene/bsdf/albedo_table.h"

namespace montelux {

namespace {

// Rows: the fourth root of alpha from 0 to 1; columns: the square root of the cosine from 0 to 1. Computed by
// quadrature over the visible normals; then the corners of every cell were raised until its interpolation is nowhere
// below the albedo.
constexpr AlbedoTable grazing_table{{
    {1.0055f, 0.9835f, 0.9192f, 0.8192f, 0.6940f, 0.5558f, 0.4183f, 0.2929f, 0.1876f, 0.1074f, 0.0530f,
     0.0211f, 0.0061f, 0.0010f, 0.0001f, 0.0001f},
    {1.0080f, 0.9860f, 0.9204f, 0.8193f, 0.6940f, 0.5558f, 0.4183f, 0.2929f, 0.1876f, 0.1074f, 0.0530f,
     0.0211f, 0.0061f, 0.0010f, 0.0001f, 0.0001f},
    {0.9996f, 1.0007f, 0.9401f, 0.8209f, 0.6944f, 0.5559f, 0.4183f, 0.2929f, 0.1877f, 0.1074f, 0.0530f,
     0.0211f, 0.0061f, 0.0010f, 0.0001f, 0.0001f},
    {0.9749f, 0.9347f, 0.9335f, 0.8287f, 0.6963f, 0.5568f, 0.4189f, 0.2931f, 0.1877f, 0.1074f, 0.0530f,
     0.0212f, 0.0061f, 0.0010f, 0.0001f, 0.0001f},
    {0.9163f, 0.8479f, 0.8798f, 0.8164f, 0.6976f, 0.5574f, 0.4193f, 0.2933f, 0.1879f, 0.1077f, 0.0530f,
     0.0212f, 0.0061f, 0.0010f, 0.0001f, 0.0001f},
    {0.8284f, 0.7888f, 0.7619f, 0.7538f, 0.6712f, 0.5502f, 0.4164f, 0.2926f, 0.1878f, 0.1079f, 0.0533f,
     0.0214f, 0.0062f, 0.0011f, 0.0001f, 0.0001f},
    {0.7111f, 0.6940f, 0.6543f, 0.6369f, 0.5979f, 0.5123f, 0.4000f, 0.2859f, 0.1861f, 0.1078f, 0.0539f,
     0.0218f, 0.0065f, 0.0012f, 0.0001f, 0.0001f},
    {0.5790f, 0.5705f, 0.5451f, 0.5166f, 0.4851f, 0.4335f, 0.3562f, 0.2643f, 0.1772f, 0.1058f, 0.0543f,
     0.0227f, 0.0070f, 0.0014f, 0.0002f, 0.0001f},
    {0.4499f, 0.4446f, 0.4282f, 0.4026f, 0.3732f, 0.3347f, 0.2843f, 0.2224f, 0.1569f, 0.0981f, 0.0529f,
     0.0236f, 0.0080f, 0.0018f, 0.0002f, 0.0001f},
    {0.3347f, 0.3308f, 0.3190f, 0.2998f, 0.2748f, 0.2447f, 0.2089f, 0.1675f, 0.1240f, 0.0824f, 0.0478f,
     0.0231f, 0.0088f, 0.0024f, 0.0004f, 0.0001f},
    {0.2401f, 0.2369f, 0.2276f, 0.2131f, 0.1939f, 0.1709f, 0.1452f, 0.1175f, 0.0888f, 0.0618f, 0.0383f,
     0.0204f, 0.0088f, 0.0028f, 0.0006f, 0.0001f},
    {0.1683f, 0.1656f, 0.1581f, 0.1468f, 0.1322f, 0.1154f, 0.0971f, 0.0781f, 0.0595f, 0.0423f, 0.0275f,
     0.0157f, 0.0075f, 0.0028f, 0.0007f, 0.0001f},
    {0.1175f, 0.1151f, 0.1087f, 0.0997f, 0.0887f, 0.0763f, 0.0633f, 0.0504f, 0.0383f, 0.0274f, 0.0181f,
     0.0108f, 0.0056f, 0.0023f, 0.0007f, 0.0001f},
    {0.0836f, 0.0812f, 0.0757f, 0.0682f, 0.0595f, 0.0502f, 0.0408f, 0.0320f, 0.0240f, 0.0171f, 0.0113f,
     0.0069f, 0.0037f, 0.0017f, 0.0006f, 0.0001f},
    {0.0618f, 0.0595f, 0.0542f, 0.0477f, 0.0405f, 0.0333f, 0.0264f, 0.0202f, 0.0149f, 0.0104f, 0.0069f,
     0.0042f, 0.0023f, 0.0011f, 0.0004f, 0.0001f},
    {0.0482f, 0.0457f, 0.0404f, 0.0344f, 0.0283f, 0.0225f, 0.0173f, 0.0129f, 0.0092f, 0.0063f, 0.0041f,
     0.0025f, 0.0014f, 0.0007f, 0.0003f, 0.0001f},
}};

float isotropic(float alpha, float root_of_cosine) {
    return grazing_table.at(std::sqrt(std::sqrt(alpha)), root_of_cosine);
}

} // namespace

float ggx_grazing_albedo(Ggx ggx, float cos_theta) {
    const float x = std::sqrt(std::max(cos_theta, 0.0f));
    const float a = isotropic(ggx.alpha_x, x);
    return std::min(1.0f, ggx.alpha_x == ggx.alpha_y ? a : std::max(a, isotropic(ggx.alpha_y, x)));
}

} // namespace montelux
