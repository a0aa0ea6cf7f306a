#include "montelux/scene/bsdf/sheen.h"

#include "montelux/mc/math/constants.h"
#include "montelux/scene/bsdf/albedo_table.h"

namespace montelux {

namespace {

// Rows: the square root of (roughness - 0.1) / 0.9 from 0 to 1; columns: the fourth root of the cosine from 0 to 1.
// Made as the table of ggx_albedo.cpp, by quadrature over the hemisphere.
constexpr AlbedoTable charlie_table{{
    {2.0318f, 1.9654f, 2.0266f, 2.1638f, 2.1166f, 1.8799f, 1.5082f, 1.0805f, 0.6768f, 0.3523f, 0.1407f,
     0.0370f, 0.0049f, 0.0002f, 0.0001f, 0.0001f},
    {1.9602f, 1.8962f, 1.9548f, 2.0899f, 2.0497f, 1.8284f, 1.4768f, 1.0690f, 0.6802f, 0.3632f, 0.1505f,
     0.0422f, 0.0062f, 0.0003f, 0.0001f, 0.0001f},
    {1.7657f, 1.7078f, 1.7609f, 1.8900f, 1.8663f, 1.6851f, 1.3872f, 1.0329f, 0.6853f, 0.3904f, 0.1782f,
     0.0582f, 0.0111f, 0.0008f, 0.0001f, 0.0001f},
    {1.5214f, 1.4711f, 1.5165f, 1.6363f, 1.6306f, 1.4957f, 1.2619f, 0.9750f, 0.6818f, 0.4203f, 0.2170f,
     0.0855f, 0.0220f, 0.0027f, 0.0001f, 0.0001f},
    {1.2896f, 1.2466f, 1.2845f, 1.3931f, 1.4016f, 1.3061f, 1.1290f, 0.9043f, 0.6664f, 0.4438f, 0.2567f,
     0.1210f, 0.0410f, 0.0081f, 0.0005f, 0.0001f},
    {1.0936f, 1.0566f, 1.0889f, 1.1868f, 1.2049f, 1.1396f, 1.0075f, 0.8336f, 0.6432f, 0.4575f, 0.2915f,
     0.1587f, 0.0678f, 0.0193f, 0.0025f, 0.0001f},
    {0.9415f, 0.9089f, 0.9367f, 1.0257f, 1.0499f, 1.0059f, 0.9066f, 0.7713f, 0.6185f, 0.4641f, 0.3195f,
     0.1950f, 0.0989f, 0.0371f, 0.0078f, 0.0001f},
    {0.8318f, 0.8020f, 0.8258f, 0.9084f, 0.9367f, 0.9073f, 0.8310f, 0.7232f, 0.5986f, 0.4689f, 0.3432f,
     0.2286f, 0.1323f, 0.0609f, 0.0184f, 0.0009f},
    {0.7600f, 0.7313f, 0.7515f, 0.8302f, 0.8616f, 0.8423f, 0.7816f, 0.6929f, 0.5882f, 0.4771f, 0.3661f,
     0.2609f, 0.1666f, 0.0893f, 0.0352f, 0.0040f},
    {0.7243f, 0.6951f, 0.7089f, 0.7860f, 0.8203f, 0.8081f, 0.7578f, 0.6816f, 0.5903f, 0.4920f, 0.3921f,
     0.2944f, 0.2025f, 0.1214f, 0.0580f, 0.0121f},
    {0.7208f, 0.6892f, 0.6940f, 0.7718f, 0.8092f, 0.8020f, 0.7582f, 0.6895f, 0.6064f, 0.5161f, 0.4234f,
     0.3307f, 0.2406f, 0.1569f, 0.0864f, 0.0270f},
    {0.7480f, 0.7116f, 0.7039f, 0.7840f, 0.8247f, 0.8211f, 0.7807f, 0.7156f, 0.6364f, 0.5502f, 0.4610f,
     0.3711f, 0.2814f, 0.1951f, 0.1192f, 0.0494f},
    {0.8032f, 0.7594f, 0.7345f, 0.8178f, 0.8617f, 0.8601f, 0.8207f, 0.7564f, 0.6779f, 0.5925f, 0.5043f,
     0.4147f, 0.3243f, 0.2353f, 0.1551f, 0.0779f},
    {0.8771f, 0.8236f, 0.7795f, 0.8661f, 0.9124f, 0.9117f, 0.8716f, 0.8057f, 0.7254f, 0.6386f, 0.5491f,
     0.4583f, 0.3661f, 0.2745f, 0.1911f, 0.1097f},
    {0.9481f, 0.8852f, 0.8213f, 0.9087f, 0.9560f, 0.9552f, 0.9137f, 0.8459f, 0.7638f, 0.6756f, 0.5853f,
     0.4936f, 0.4006f, 0.3078f, 0.2232f, 0.1408f},
    {0.9546f, 0.8888f, 0.8183f, 0.9037f, 0.9504f, 0.9499f, 0.9097f, 0.8437f, 0.7642f, 0.6792f, 0.5923f,
     0.5044f, 0.4151f, 0.3258f, 0.2446f, 0.1655f},
}};

} // namespace

float Sheen::charlie_albedo(float cos_theta) const {
    const float roughness = std::sqrt(alpha);
    const float row = std::sqrt(std::max(0.0f, (roughness - least_roughness) / (1 - least_roughness)));
    return charlie_table.at(row, std::sqrt(std::sqrt(cos_theta)));
}

// Fit of Conty and Kulla 2017 to Smith's Lambda of their distribution.
float Sheen::lambda(float cos_theta) const {
    const float w = (1 - alpha) * (1 - alpha);
    const auto mix = [&](float rough, float sharp) { return rough + w * (sharp - rough); };
    const float a = mix(21.5473f, 25.3245f), b = mix(3.82987f, 3.32435f), c = mix(0.19823f, 0.16801f);
    const float d = mix(-1.97760f, -1.27393f), e = mix(-4.32054f, -4.85967f);
    const auto l = [&](float x) { return a / (1 + b * std::pow(x, c)) + d * x + e; };
    return cos_theta < 0.5f ? std::exp(l(cos_theta)) : std::exp(2 * l(0.5f) - l(1 - cos_theta));
}

float Sheen::value(Vec3f wo, Vec3f wi) const {
    const float cos_o = abs_cos_theta(wo), cos_i = abs_cos_theta(wi);
    const Vec3f h = wo + wi;
    const float len2 = length_squared(h);
    if (!(len2 > 0) || cos_o == 0) return 0;
    const float sin2 = std::clamp((h.x * h.x + h.y * h.y) / len2, 0.0f, 1.0f);
    const float d = (2 + 1 / alpha) * std::pow(sin2, 0.5f / alpha) * inv_two_pi_f;
    const float charlie = d / ((1 + lambda(cos_o) + lambda(cos_i)) * 4 * cos_o);
    return charlie / std::max({1.0f, charlie_albedo(cos_o), charlie_albedo(cos_i)});
}

} // namespace montelux
