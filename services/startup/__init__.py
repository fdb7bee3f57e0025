"""Program start: the fast ledger gate, and the compilation of kernels."""
