"""Analysis of theorem statements: the definition each kernel is proved against, and which are restatements."""
