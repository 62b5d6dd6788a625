// SPDX-License-Identifier: MIT
/// What does a file's material look like in Whitted shading? MTL is nearly Whitted's model; glTF is mapped
/// onto it: smooth metals become mirrors tinted by their colour, transmission becomes refraction, rough
/// metals stay diffuse.
#include "io/assimp_material.hpp"

#include <assimp/GltfMaterial.h>
#include <assimp/ObjMaterial.h>
#include <assimp/material.h>
#include <assimp/scene.h>

#include <algorithm>
#include <cmath>

#include "io/gltf_schema.hpp"
#include "io/texture.hpp"

namespace setka::io::detail {

namespace {

/// A metal rougher than this shows no mirror image.
constexpr float mirror_roughness = 0.5f;

float clamped(float value, float low, float high, float otherwise) {
    return std::isfinite(value) ? std::clamp(value, low, high) : otherwise;
}

std::optional<float> number(const aiMaterial& source, const char* key, unsigned type, unsigned index) {
    ai_real value = 0;
    if (source.Get(key, type, index, value) != aiReturn_SUCCESS || !std::isfinite(value)) return std::nullopt;
    return static_cast<float>(value);
}

struct Colour {
    Float3 rgb;
    float alpha = 1;
};

std::optional<Colour> colour(const aiMaterial& source, const char* key, unsigned type, unsigned index) {
    aiColor4D value(0, 0, 0, 1);
    if (source.Get(key, type, index, value) != aiReturn_SUCCESS) return std::nullopt;
    const auto channel = [](float c) { return clamped(c, 0, 1e6f, 0); };
    return Colour{{channel(value.r), channel(value.g), channel(value.b)}, clamped(value.a, 0, 1, 1)};
}

Float3 at_most_one(const Float3& c) {
    return {std::min(c.x, 1.0f), std::min(c.y, 1.0f), std::min(c.z, 1.0f)};
}
Float3 times(const Float3& a, const Float3& b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
Float3 times(const Float3& a, float b) { return {a.x * b, a.y * b, a.z * b}; }
float largest(const Float3& c) { return std::max({c.x, c.y, c.z}); }

std::string name_of(const aiMaterial& source) {
    aiString name;
    return source.Get(AI_MATKEY_NAME, name) == aiReturn_SUCCESS ? name.C_Str() : "";
}

/// The mean colour of the texture named by a material: embedded ("*3", or by its name), or a file in
/// `folder`.
std::optional<Float3> texture_colour(const aiMaterial& source, aiTextureType type, const aiScene* scene,
                                     const std::filesystem::path& folder) {
    aiString path;
    if (source.GetTexture(type, 0, &path) != aiReturn_SUCCESS || path.length == 0) return std::nullopt;
    if (const aiTexture* embedded = scene ? scene->GetEmbeddedTexture(path.C_Str()) : nullptr) {
        // Height 0: pcData holds mWidth bytes of an encoded image.
        if (embedded->mHeight != 0 || !embedded->pcData) return std::nullopt;
        return mean_colour(
            std::span(reinterpret_cast<const unsigned char*>(embedded->pcData), embedded->mWidth));
    }
    std::string name = path.C_Str();
    std::replace(name.begin(), name.end(), '\\', '/');  // MTL files come from Windows
    const std::filesystem::path texture = name;
    for (const std::filesystem::path& candidate :
         {folder / texture, folder / decode_uri(name), folder / texture.filename()})
        if (const std::optional<Float3> mean = mean_colour(candidate)) return mean;
    return std::nullopt;
}

/// A Blinn-Phong exponent with a highlight about as wide as a microfacet surface of this roughness: 2 /
/// roughness^4 - 2.
float shininess_of_roughness(float roughness) {
    const float square = roughness * roughness;
    return std::clamp(2 / std::max(square * square, 1e-5f) - 2, 1.0f, 65536.0f);
}

}  // namespace

ImportedMaterial convert_mtl(const aiMaterial& source, const std::filesystem::path& folder) {
    ImportedMaterial imported;
    Material& m = imported.material;
    m.name = name_of(source);
    const float exponent = number(source, AI_MATKEY_SHININESS).value_or(0);
    // Faces without a material, or with one that no MTL file defines: filter_mtl gives those an exponent
    // above 0.
    if (m.name == AI_DEFAULT_MATERIAL_NAME || exponent <= 0) return imported;
    imported.has_colour = true;
    m.diffuse = at_most_one(colour(source, AI_MATKEY_COLOR_DIFFUSE).value_or(Colour{m.diffuse}).rgb);
    if (const auto mean = texture_colour(source, aiTextureType_DIFFUSE, nullptr, folder)) {
        // Exporters write Kd 0 0 0 beside a texture that replaces it.
        m.diffuse = largest(m.diffuse) > 0 ? times(m.diffuse, *mean) : *mean;
    }
    m.specular = at_most_one(colour(source, AI_MATKEY_COLOR_SPECULAR).value_or(Colour{}).rgb);
    m.emission = colour(source, AI_MATKEY_COLOR_EMISSIVE).value_or(Colour{}).rgb;
    m.shininess = clamped(exponent, 1, 65536, 32);
    m.transparency = 1 - clamped(number(source, AI_MATKEY_OPACITY).value_or(1), 0, 1, 1);
    m.transmission = at_most_one(colour(source, AI_MATKEY_COLOR_TRANSPARENT).value_or(Colour{{1, 1, 1}}).rgb);
    const float index = number(source, AI_MATKEY_REFRACTI).value_or(1);
    // Ni below 1 (often 0) is a field that nobody filled in.
    m.refractive_index = index >= 1 && index <= 10 ? index : 1;
    int illumination = 2;
    (void)source.Get(AI_MATKEY_OBJ_ILLUM, illumination);
    const bool mirror = illumination == 3 || illumination == 5 || illumination == 8;
    const bool glass = illumination == 4 || illumination == 6 || illumination == 7 || illumination == 9;
    // MTL's mirror term is Ks times what the mirror ray sees.
    if ((mirror || glass) && largest(m.specular) > 0)
        m.reflectivity = mirror ? 1.0f : std::min(largest(m.specular), 1.0f);
    if (glass && m.transparency == 0) m.transparency = 1;
    if (glass && m.refractive_index == 1) m.refractive_index = 1.5f;
    return imported;
}

ImportedMaterial convert_gltf(const aiMaterial& source, const aiScene& scene,
                              const std::filesystem::path& folder) {
    ImportedMaterial imported;
    Material& m = imported.material;
    m.name = name_of(source);
    Colour base = colour(source, AI_MATKEY_BASE_COLOR)
                      .value_or(colour(source, AI_MATKEY_COLOR_DIFFUSE).value_or(Colour{{1, 1, 1}}));
    base.rgb = at_most_one(base.rgb);
    std::optional<Float3> mean = texture_colour(source, aiTextureType_BASE_COLOR, &scene, folder);
    if (!mean) mean = texture_colour(source, aiTextureType_DIFFUSE, &scene, folder);
    if (mean) base.rgb = times(base.rgb, *mean);
    imported.has_colour = true;  // white, if it says nothing

    float metallic = clamped(number(source, AI_MATKEY_METALLIC_FACTOR).value_or(1), 0, 1, 1);
    float roughness = clamped(number(source, AI_MATKEY_ROUGHNESS_FACTOR).value_or(1), 0, 1, 1);
    const std::optional<float> glossiness = number(source, AI_MATKEY_GLOSSINESS_FACTOR);
    if (glossiness) {
        metallic = 0;
        roughness = 1 - clamped(*glossiness, 0, 1, 0);
    }
    const float smooth = std::max(0.0f, 1 - roughness / mirror_roughness);
    const float mirror = metallic * smooth * smooth;
    // A rough metal keeps its colour as diffuse: one mirror ray cannot show its blurred reflection.
    m.diffuse = times(base.rgb, 1 - mirror);
    for (auto [target, tint] :
         {std::pair(&m.specular.x, base.rgb.x), {&m.specular.y, base.rgb.y}, {&m.specular.z, base.rgb.z}})
        *target = 0.04f * (1 - metallic) + tint * metallic;
    if (glossiness)
        m.specular = at_most_one(colour(source, AI_MATKEY_COLOR_SPECULAR).value_or(Colour{m.specular}).rgb);
    m.shininess = shininess_of_roughness(roughness);
    m.reflectivity = mirror;
    m.emission = colour(source, AI_MATKEY_COLOR_EMISSIVE).value_or(Colour{}).rgb;

    const float transmission = clamped(number(source, AI_MATKEY_TRANSMISSION_FACTOR).value_or(0), 0, 1, 0);
    aiString alpha_mode;
    (void)source.Get(AI_MATKEY_GLTF_ALPHAMODE, alpha_mode);
    if (transmission > 0) {
        m.transparency = transmission * (1 - metallic);
        m.transmission = base.rgb;
        m.reflectivity = std::max(m.reflectivity, 0.04f * transmission);
    } else if (std::string_view(alpha_mode.C_Str()) == "BLEND" && base.alpha < 1) {
        // Alpha is coverage: what is behind shows unbent.
        m.transparency = 1 - base.alpha;
        m.refractive_index = 1;
    }
    return imported;
}

}  // namespace setka::io::detail
