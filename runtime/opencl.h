// SPDX-License-Identifier: MIT
// The OpenCL C++ bindings with our settings; slow to compile, so only runtime/*.cpp include this.
// MINIMUM is 110: with 200 the bindings call OpenCL 2 entry points that hang on 1.2 platforms.
#pragma once
#define CL_TARGET_OPENCL_VERSION 300
#define CL_HPP_TARGET_OPENCL_VERSION 300
#define CL_HPP_MINIMUM_OPENCL_VERSION 110
#define CL_HPP_ENABLE_EXCEPTIONS
#include <CL/opencl.hpp>
