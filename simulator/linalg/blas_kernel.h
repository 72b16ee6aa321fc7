#pragma once

#include <functional>
#include <optional>
#include <string>

#include "simulator/common/words.h"

/// OpenBLAS holds kernels for many processors and takes one when the process is loaded, by the
/// processor's family and model. A model that is newer than the library gets its oldest kernel
/// ("Prescott", SSE3), whatever the processor can do: three times slower, and nobody is told.
/// So the program compares what was taken with what library and processor have and, where it is
/// less, starts itself anew with OPENBLAS_CORETYPE set, which its children inherit.
namespace faultsim {

/// The widest vectors that a processor has, or that a kernel computes with.
enum class VectorSet { sse, avx, avx2, avx512 };
constexpr auto words(VectorSet) { return std::array{"SSE", "AVX", "AVX2", "AVX-512"}; }

/// What the processor and its operating system offer.
VectorSet vector_set_of_processor();
/// What a kernel of OpenBLAS needs; none for a name that we do not know.
std::optional<VectorSet> vector_set_of_kernel(const std::string& name);

/// The kernel to take instead of `taken`: the widest that library and processor have, if it is
/// wider than that of `taken`; none where `taken` is as wide, or unknown to us (a newer library).
/// @param has  whether the library holds a kernel of that name.
std::optional<std::string> wider_kernel(const std::string& taken, VectorSet processor,
                                        const std::function<bool(const std::string&)>& has);

/// Executes this program again: same process id, descriptors, arguments and, for people who look
/// with ps, name. Returns where that fails.
void start_anew(char** argv);

/// Called by start_blas (blas_start.h). Starts the program anew (execv, same process id,
/// descriptors and arguments) where OpenBLAS took a kernel that is less than it could be; returns
/// otherwise, also where that fails. An OPENBLAS_CORETYPE that the user has set is never touched.
/// @throws ResourceError where that one needs instructions that the processor has not.
void choose_blas_kernel(char** argv);

/// Why the kernel in use is in use, for people: "chosen by OpenBLAS", "set by OPENBLAS_CORETYPE",
/// "OpenBLAS 0.3.21 does not know this processor and took Prescott".
std::string blas_kernel_reason();

}  // namespace faultsim
