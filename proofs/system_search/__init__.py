"""Bounded search through the composition of the steps that run, for designs that are broken. No proof."""
