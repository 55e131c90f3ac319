#include "product_kernels.hpp"

namespace mstsl {
const ProductKernel kAvx2Product = product_kernel<4, 2, 6>("AVX2");
}
