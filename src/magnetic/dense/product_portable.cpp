#include "product_kernels.hpp"

namespace mstsl {
const ProductKernel kPortableProduct = product_kernel<2, 2, 4>("portable");
}
