"""A confirmed report for other tools: JUnit XML, SARIF, CSV, and a signed statement on all of it."""
