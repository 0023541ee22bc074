"""Who sees what: small specimens of the defect classes, the usual tools of a PC, and this one."""
