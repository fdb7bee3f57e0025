"""A confirmed report for other tools: JUnit XML, SARIF, CSV, and a signed statement over all of it."""
