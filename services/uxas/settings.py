"""The kinds of attributes for user-defined services (`docs/guides/own-service.md`)."""

from cratous.services.loading.uxas_settings import Attr, choice, flag, number, whole

__all__ = ["Attr", "choice", "flag", "number", "whole"]
