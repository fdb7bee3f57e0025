"""The report with all its sections, and as PDF: views of a confirmed report.json."""
