"""Before anything runs: the ledger gate, quickly, and the compilation of kernels."""
