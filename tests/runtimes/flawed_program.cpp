// SPDX-License-Identifier: MIT
/// Does the checker see what it is there for? Runs a kernel with a race in local memory and one that copies
/// what nobody wrote, and leaves it to Oclgrind to say so.
#define CL_HPP_TARGET_OPENCL_VERSION 120
#define CL_HPP_MINIMUM_OPENCL_VERSION 120
#define CL_HPP_ENABLE_EXCEPTIONS
#define CL_TARGET_OPENCL_VERSION 120
#include <CL/opencl.hpp>
#include <cstdio>
#include <vector>

namespace {

constexpr const char* source = R"(
__kernel void races(__global const uint* in, __global uint* out) {
    __local uint shared[8];
    const uint item = get_local_id(0);
    shared[item] = in[item];
    out[item] = shared[(item + 1u) % 8u];  /* no barrier before it */
}
__kernel void reads_unwritten(__global const uint* unwritten, __global uint* out) {
    if (unwritten[get_local_id(0)] > 1u) out[get_local_id(0)] = 1u;
}
)";

void run() {
    std::vector<cl::Platform> platforms;
    cl::Platform::get(&platforms);
    std::vector<cl::Device> devices;
    platforms.at(0).getDevices(CL_DEVICE_TYPE_ALL, &devices);
    const cl::Device device = devices.at(0);
    const cl::Context context(device);
    const cl::CommandQueue queue(context, device);
    const cl::Program program(context, source, true);
    const cl_uint values[8] = {};
    const cl::Buffer written(context, CL_MEM_READ_WRITE, sizeof values);
    const cl::Buffer unwritten(context, CL_MEM_READ_WRITE, sizeof values);
    const cl::Buffer out(context, CL_MEM_READ_WRITE, sizeof values);
    queue.enqueueWriteBuffer(written, CL_TRUE, 0, sizeof values, values);
    const auto launch = [&](const char* name, const cl::Buffer& in) {
        cl::Kernel kernel(program, name);
        kernel.setArg(0, in);
        kernel.setArg(1, out);
        queue.enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(8), cl::NDRange(8));
        queue.finish();
    };
    launch("races", written);
    launch("reads_unwritten", unwritten);
}

}  // namespace

int main() {
    try {
        run();
        return 0;
    } catch (const cl::Error& error) {
        std::fprintf(stderr, "%s returned %d\n", error.what(), error.err());
        return 1;
    }
}
