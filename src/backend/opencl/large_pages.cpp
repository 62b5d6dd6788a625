// SPDX-License-Identifier: MIT
#include "backend/opencl/large_pages.hpp"

#include <cstdlib>
#include <memory>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace setka::backend {

#if defined(__linux__) && defined(MADV_HUGEPAGE)

namespace {

/// Of x86-64, and of most others that have pages of 4 KiB. Elsewhere it is an alignment like any other.
constexpr std::uint64_t large_page = std::uint64_t(2) << 20;

struct Free {
    void operator()(void* memory) const noexcept { std::free(memory); }
};

}  // namespace

cl::Buffer make_large_page_buffer(const cl::Context& context, std::uint64_t size_bytes) {
    if (size_bytes < 2 * large_page) return {};
    const std::uint64_t whole = size_bytes / large_page * large_page;
    std::unique_ptr<void, Free> memory(std::aligned_alloc(large_page, whole + (size_bytes > whole ? large_page : 0)));
    if (!memory) return {};
    // What is left behind the last whole page stays in small ones. A system without large pages says so, and that is no matter.
    (void)madvise(memory.get(), whole, MADV_HUGEPAGE);
    cl::Buffer buffer(context, CL_MEM_READ_WRITE | CL_MEM_USE_HOST_PTR, size_bytes, memory.get());
    // Commands may need it longer than the last reference from here is there.
    buffer.setDestructorCallback([](cl_mem, void* freed) { std::free(freed); }, memory.get());
    (void)memory.release();
    return buffer;
}

#else

cl::Buffer make_large_page_buffer(const cl::Context&, std::uint64_t) { return {}; }

#endif

}  // namespace setka::backend
