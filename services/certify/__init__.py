"""The certificate of a flight: builds `report.json` from the evidence and `report.html` from report.json."""
