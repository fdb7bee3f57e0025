"""Mutation of kernels, definitions and premises: does a theorem notice?"""
