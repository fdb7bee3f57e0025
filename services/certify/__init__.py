"""The certificate of a flight: `report.json` from the evidence, `report.html` from report.json."""
