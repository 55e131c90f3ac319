#pragma once

#include <vector>

#include "product_kernel.hpp"

namespace mstsl {

extern const ProductKernel kPortableProduct;
#ifdef MSTSL_X86_KERNELS
extern const ProductKernel kAvx2Product;    ///< needs AVX2
extern const ProductKernel kAvx512Product;  ///< needs AVX-512F
#endif

/// The kernels that this processor runs, the fastest last.
std::vector<const ProductKernel*> usable_product_kernels();

}  // namespace mstsl
