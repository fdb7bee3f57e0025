"""What theorems say of kernels: which definition each is held against, and what is restated."""
