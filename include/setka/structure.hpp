// SPDX-License-Identifier: MIT
/// What can rays be traced against? The handle that every acceleration structure shares, and the tables it names.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "setka/device.hpp"
#include "setka/device_scene.hpp"
#include "setka/scene.hpp"

namespace setka {

enum class StructureKind {
    BruteForce,   ///< no structure: every ray meets every triangle; the oracle
    UniformGrid,  ///< Maltsev & Mikhaylyuk 2012
};

[[nodiscard]] const char* to_string(StructureKind kind) noexcept;

/// World-space triangles and the instances they belong to: what every structure keeps of a scene.
struct WorldGeometry {
    Bounds bounds{};
    std::uint32_t triangle_count = 0;
    std::uint32_t instance_count = 0;
    std::uint32_t common_mask = 0;           ///< bits that the mask of every instance with triangles has
    Buffer<float> triangles;                 ///< 9 a triangle: v0, v1, v2
    Buffer<std::uint32_t> instance_starts;   ///< instance_count + 1
    Buffer<::SetkaInstance> instances;
};

/// A named table of a structure.
struct Section {
    std::string name;
    std::uint64_t size_bytes = 0;
};

/// A 128-bit digest (XXH3) of a structure's tables.
struct Digest {
    std::uint64_t high = 0, low = 0;
    friend bool operator==(const Digest&, const Digest&) = default;
    [[nodiscard]] std::string to_string() const;  ///< 32 hexadecimal digits
};

/// A built structure on a device; immutable, shared by copies.
class Structure {
  public:
    virtual ~Structure() = default;
    [[nodiscard]] virtual StructureKind kind() const noexcept = 0;
    [[nodiscard]] virtual std::vector<Section> sections() const = 0;
    [[nodiscard]] const WorldGeometry& geometry() const noexcept { return geometry_; }
    /// Bytes of all sections.
    [[nodiscard]] std::uint64_t size_bytes() const;

  protected:
    explicit Structure(WorldGeometry geometry) : geometry_(std::move(geometry)) {}

  private:
    WorldGeometry geometry_;
};

/// Every triangle, in order: the structure whose answers define what a hit is. For tests, small scenes and doubts.
class BruteForce final : public Structure {
  public:
    /// Transforms the scene's triangles. Throws InvalidData for a triangle that is not finite in world space.
    [[nodiscard]] static BruteForce build(Queue& queue, const DeviceScene& scene);

    [[nodiscard]] StructureKind kind() const noexcept override { return StructureKind::BruteForce; }
    [[nodiscard]] std::vector<Section> sections() const override;
    /// The triangles again, `lane_count` at a time with equal components side by side, for wide tests.
    [[nodiscard]] const Buffer<float>& packets() const noexcept { return packets_; }

    static constexpr std::uint32_t lane_count = 16;

  private:
    BruteForce(WorldGeometry geometry, Buffer<float> packets)
        : Structure(std::move(geometry)), packets_(std::move(packets)) {}
    Buffer<float> packets_;
};

}  // namespace setka
