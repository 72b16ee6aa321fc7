#pragma once

#include <cstddef>

/// LAPACK of OpenBLAS, as Fortran has it: lengths of texts at the end. For this folder.
extern "C" {
void dpotrf_(const char* uplo, const int* n, double* a, const int* lda, int* info,
             std::size_t uplo_length);
void dpotrs_(const char* uplo, const int* n, const int* nrhs, const double* a, const int* lda,
             double* b, const int* ldb, int* info, std::size_t uplo_length);
void dpocon_(const char* uplo, const int* n, const double* a, const int* lda, const double* norm,
             double* reciprocal, double* work, int* iwork, int* info, std::size_t uplo_length);
double dlansy_(const char* norm, const char* uplo, const int* n, const double* a, const int* lda,
               double* work, std::size_t norm_length, std::size_t uplo_length);
void dgetrf_(const int* m, const int* n, double* a, const int* lda, int* pivots, int* info);
void dgetrs_(const char* trans, const int* n, const int* nrhs, const double* a, const int* lda,
             const int* pivots, double* b, const int* ldb, int* info, std::size_t trans_length);
void sgetrf_(const int* m, const int* n, float* a, const int* lda, int* pivots, int* info);
void sgetrs_(const char* trans, const int* n, const int* nrhs, const float* a, const int* lda,
             const int* pivots, float* b, const int* ldb, int* info, std::size_t trans_length);
void dlaswp_(const int* n, double* a, const int* lda, const int* k1, const int* k2,
             const int* pivots, const int* increment);
void slaswp_(const int* n, float* a, const int* lda, const int* k1, const int* k2,
             const int* pivots, const int* increment);
}
