// SPDX-License-Identifier: MIT
/// What does assimp see of the file system? Streams over bytes in memory, so that nothing it opens can block
/// or grow.
#include "io/assimp_files.hpp"

#include <algorithm>
#include <cstring>

#include "io/file.hpp"
#include "io/readers.hpp"
#include "io/unicode.hpp"

namespace setka::io::detail {

namespace {

class MemoryStream final : public Assimp::IOStream {
  public:
    explicit MemoryStream(std::string bytes) : bytes_(std::move(bytes)) {}

    std::size_t Read(void* buffer, std::size_t item_bytes, std::size_t count) override {
        if (item_bytes == 0) return 0;
        const std::size_t items = std::min(count, (bytes_.size() - at_) / item_bytes);
        if (items) std::memcpy(buffer, bytes_.data() + at_, items * item_bytes);
        at_ += items * item_bytes;
        return items;
    }
    std::size_t Write(const void*, std::size_t, std::size_t) override { return 0; }
    aiReturn Seek(std::size_t offset, aiOrigin origin) override {
        const std::size_t base = origin == aiOrigin_SET ? 0 : origin == aiOrigin_CUR ? at_ : bytes_.size();
        if (offset > bytes_.size() - base) return aiReturn_FAILURE;
        at_ = base + offset;
        return aiReturn_SUCCESS;
    }
    [[nodiscard]] std::size_t Tell() const override { return at_; }
    [[nodiscard]] std::size_t FileSize() const override { return bytes_.size(); }
    void Flush() override {}

  private:
    std::string bytes_;
    std::size_t at_ = 0;
};

}  // namespace

bool AssimpFiles::Exists(const char* path) const {
    std::error_code error;
    return file_ == path || std::filesystem::is_regular_file(path, error);
}

Assimp::IOStream* AssimpFiles::Open(const char* path, const char* mode) {
    if (std::strchr(mode, 'w') || std::strchr(mode, 'a')) return nullptr;
    if (file_ == path) return new MemoryStream(bytes_);
    try {
        std::string bytes = read_file(path);
        if (sidecars_ == Sidecars::Materials) bytes = filter_mtl(to_utf8(path, std::move(bytes)));
        return new MemoryStream(std::move(bytes));
    } catch (const Error&) {
        return nullptr;  // what assimp expects of a file that is not there
    }
}

}  // namespace setka::io::detail
