"""The campaign file format: `campaign.schema.json`, the published JSON Schema (draft 2020-12)."""
