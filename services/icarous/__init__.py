"""ICAROUS: one instance per protected vehicle monitors, avoids and hands back."""
