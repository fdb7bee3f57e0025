"""What a campaign file says: `campaign.schema.json`, the published JSON Schema (draft 2020-12)."""
