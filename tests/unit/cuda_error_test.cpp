// SPDX-License-Identifier: MIT
/// What does CUDA's failure say? Categories, and what a user can do, for every code that a user may meet; no
/// GPU is needed.
#include <gtest/gtest.h>

#include <cstring>

#include "backend/cuda/cuda_check.hpp"
#include "backend/cuda/cuda_registry.hpp"

namespace setka::backend {
namespace {

using Category = ErrorCategory;

/// Each word is in the text; else the text.
::testing::AssertionResult says(const std::string& text, std::initializer_list<const char*> words) {
    for (const char* word : words)
        if (text.find(word) == std::string::npos)
            return ::testing::AssertionFailure() << "no '" << word << "' in: " << text;
    return ::testing::AssertionSuccess();
}

TEST(CudaError, NamesTheCallTheCodeAndItsText) {
    const Error error = cuda_error("writing 'rays'", cudaErrorInvalidValue);
    EXPECT_EQ(error.category(), Category::DeviceFailed);
    EXPECT_STREQ(error.what(), "writing 'rays' failed: cudaErrorInvalidValue (invalid argument)");
}

TEST(CudaError, OutOfMemoryIsACategoryOfItsOwn) {
    const Error error = cuda_error("allocating 'rays' (4096 bytes)", cudaErrorMemoryAllocation);
    EXPECT_EQ(error.category(), Category::OutOfMemory);
    EXPECT_TRUE(says(error.what(), {"'rays' (4096 bytes)", "cudaErrorMemoryAllocation", "nvidia-smi"}));
}

TEST(CudaError, WhatTheDriverOrTheBuildLacksIsUnsupported) {
    const struct {
        cudaError_t code;
        const char* advice;
    } cases[] = {{cudaErrorNoDevice, "CUDA_VISIBLE_DEVICES"},
                 {cudaErrorInsufficientDriver, "update the NVIDIA driver"},
                 {cudaErrorCallRequiresNewerDriver, "update the NVIDIA driver"},
                 {cudaErrorUnsupportedPtxVersion, "update the NVIDIA driver"},
                 {cudaErrorSystemDriverMismatch, "restart the machine"},
                 {cudaErrorNoKernelImageForDevice, "CMAKE_CUDA_ARCHITECTURES"},
                 {cudaErrorInvalidKernelImage, "CMAKE_CUDA_ARCHITECTURES"},
                 {cudaErrorJitCompilerNotFound, "CMAKE_CUDA_ARCHITECTURES"}};
    for (const auto& [code, advice] : cases) {
        const Error error = cuda_error("opening cuda:0", code);
        EXPECT_EQ(error.category(), Category::Unsupported) << error.what();
        EXPECT_TRUE(says(error.what(), {"opening cuda:0 failed: ", cudaGetErrorName(code), advice}));
    }
}

TEST(CudaError, ALaunchThatDoesNotFitNamesTheOption) {
    for (const cudaError_t code : {cudaErrorLaunchOutOfResources, cudaErrorInvalidConfiguration}) {
        const Error error = cuda_error("launching grid_emit", code);
        EXPECT_EQ(error.category(), Category::DeviceFailed);
        EXPECT_FALSE(is_context_lost(code));
        EXPECT_TRUE(says(error.what(), {"launching grid_emit", "smaller work_group_size"}));
    }
}

TEST(CudaError, ALostContextSaysWhatToDo) {
    for (const cudaError_t code :
         {cudaErrorIllegalAddress, cudaErrorLaunchTimeout, cudaErrorAssert, cudaErrorHardwareStackError,
          cudaErrorIllegalInstruction, cudaErrorMisalignedAddress, cudaErrorInvalidAddressSpace,
          cudaErrorInvalidPc, cudaErrorLaunchFailure, cudaErrorECCUncorrectable, cudaErrorMpsClientTerminated,
          cudaErrorExternalDevice, static_cast<cudaError_t>(226), static_cast<cudaError_t>(721)}) {
        const Error error = cuda_error("waiting for cuda:0", code);
        EXPECT_TRUE(is_context_lost(code)) << error.what();
        EXPECT_EQ(error.category(), Category::DeviceFailed) << error.what();
        EXPECT_TRUE(says(error.what(), {"the CUDA context of this process is lost", "every later call",
                                        "restart the process", "SETKA_SYNC=1"}));
    }
    EXPECT_TRUE(says(cuda_error("", cudaErrorLaunchTimeout).what(), {"display"}));
    EXPECT_TRUE(says(cuda_error("", cudaErrorECCUncorrectable).what(), {"hardware"}));
    for (const cudaError_t code : {cudaSuccess, cudaErrorMemoryAllocation, cudaErrorInvalidValue,
                                   cudaErrorNoDevice, cudaErrorNotReady, cudaErrorUnknown})
        EXPECT_FALSE(is_context_lost(code)) << cudaGetErrorName(code);
}

TEST(CudaError, CheckThrowsForFailuresOnly) {
    EXPECT_NO_THROW(check(cudaSuccess, "doing nothing"));
    try {
        check(cudaErrorNoDevice, "selecting cuda:0");
        FAIL() << "nothing was thrown";
    } catch (const Error& error) {
        EXPECT_TRUE(says(error.what(), {"selecting cuda:0", "cudaErrorNoDevice"}));
    }
}

TEST(CudaError, ALostContextIsLoggedOnceByDestructors) {
    ::testing::internal::CaptureStderr();
    check_noexcept(cudaSuccess, "cudaFree");
    check_noexcept(cudaErrorCudartUnloading, "cudaFree");
    EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
    ::testing::internal::CaptureStderr();
    check_noexcept(cudaErrorInvalidValue, "cudaFree");
    check_noexcept(cudaErrorInvalidValue, "cudaFreeHost");
    EXPECT_TRUE(says(::testing::internal::GetCapturedStderr(), {"cudaFree failed", "cudaFreeHost failed"}));
    ::testing::internal::CaptureStderr();
    check_noexcept(cudaErrorIllegalAddress, "cudaFree");
    check_noexcept(cudaErrorIllegalAddress, "cudaFreeHost");
    const std::string log = ::testing::internal::GetCapturedStderr();
    EXPECT_TRUE(says(log, {"cudaFree failed: cudaErrorIllegalAddress", "context of this process is lost"}));
    EXPECT_EQ(log.find("cudaFreeHost"), std::string::npos) << log;
}

TEST(CudaNotes, SayWhyThereIsNoPlatform) {
    EXPECT_EQ(cuda_platform_note(cudaSuccess, 0, 13020),
              "CUDA: no NVIDIA driver was found; for an NVIDIA GPU install one for CUDA 13.2 or later");
    EXPECT_TRUE(says(cuda_platform_note(cudaErrorInsufficientDriver, 12020, 13000),
                     {"CUDA: cudaErrorInsufficientDriver", "driver for CUDA 12.2", "built with CUDA 13.0",
                      "update the NVIDIA driver"}));
    EXPECT_TRUE(says(cuda_platform_note(cudaErrorNoDevice, 13000, 13000),
                     {"cudaErrorNoDevice", "CUDA_VISIBLE_DEVICES"}));
    EXPECT_TRUE(says(cuda_platform_note(cudaErrorInitializationError, 0, 13000),
                     {"cudaErrorInitializationError", "driver for CUDA unknown"}));
}

TEST(CudaNotes, SayWhyADeviceCannotBeUsed) {
    cudaDeviceProp properties{};
    std::strcpy(properties.name, "Tesla V100");
    properties.major = 7;
    properties.minor = 0;
    EXPECT_TRUE(says(cuda_device_note(cudaErrorNoKernelImageForDevice, 1, properties),
                     {"CUDA device 1 (Tesla V100, compute capability 7.0) cannot be used: ",
                      "cudaErrorNoKernelImageForDevice", "CMAKE_CUDA_ARCHITECTURES"}));
}

}  // namespace
}  // namespace setka::backend
