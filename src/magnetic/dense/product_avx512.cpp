#include "product_kernels.hpp"

namespace mstsl {
const ProductKernel kAvx512Product = product_kernel<8, 3, 8>("AVX-512");
}
