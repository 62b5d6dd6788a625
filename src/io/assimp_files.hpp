// SPDX-License-Identifier: MIT
/// What does assimp see of the file system? The file itself as bytes in memory, and regular files of sane
/// size beside it.
#pragma once

#include <assimp/IOStream.hpp>
#include <assimp/IOSystem.hpp>
#include <filesystem>
#include <string>

namespace setka::io::detail {

/// What lies beside the file: MTL files, which are filtered, or buffers, which are bytes.
enum class Sidecars { Materials, Buffers };

class AssimpFiles final : public Assimp::IOSystem {
  public:
    /// `bytes` stand for `file`, whatever the disk says.
    AssimpFiles(const std::filesystem::path& file, std::string bytes, Sidecars sidecars)
        : file_(file.string()), bytes_(std::move(bytes)), sidecars_(sidecars) {}

    [[nodiscard]] bool Exists(const char* path) const override;
    [[nodiscard]] char getOsSeparator() const override { return '/'; }
    [[nodiscard]] Assimp::IOStream* Open(const char* path, const char* mode) override;
    void Close(Assimp::IOStream* stream) override { delete stream; }

  private:
    std::string file_;
    std::string bytes_;
    Sidecars sidecars_;
};

}  // namespace setka::io::detail
