#pragma once

namespace faultsim::python {

/// What start_blas() does for a program, for a process that was there before: where OpenBLAS took a
/// kernel that is less than the processor has, it is asked to choose again. So results have the
/// bits of those of `faultsim run`. An OPENBLAS_CORETYPE that the user has set is not touched.
void choose_blas_kernel_in_place();

}  // namespace faultsim::python
