"""ICAROUS: one instance per protected vehicle watches, avoids and hands back."""
