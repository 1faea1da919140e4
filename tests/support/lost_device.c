// SPDX-License-Identifier: MIT
// Preloaded into the command: the device is gone after LOSE_AFTER launches of kernels.
#define _GNU_SOURCE
#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>
#include <dlfcn.h>
#include <stdlib.h>

typedef cl_int (*Launch)(cl_command_queue, cl_kernel, cl_uint, const size_t*, const size_t*, const size_t*, cl_uint,
                         const cl_event*, cl_event*);

cl_int clEnqueueNDRangeKernel(cl_command_queue queue, cl_kernel kernel, cl_uint dimensions, const size_t* offset,
                              const size_t* global, const size_t* local, cl_uint count, const cl_event* waits,
                              cl_event* event) {
    static long launches = 0;
    const char* limit = getenv("LOSE_AFTER");
    if (limit && launches++ >= atol(limit)) return CL_DEVICE_NOT_AVAILABLE;
    const Launch launch = (Launch)dlsym(RTLD_NEXT, "clEnqueueNDRangeKernel");
    return launch(queue, kernel, dimensions, offset, global, local, count, waits, event);
}
