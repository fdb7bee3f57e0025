"""The report with all sections, also as PDF: views of a confirmed report.json."""
